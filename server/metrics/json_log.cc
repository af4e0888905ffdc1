#include "server/metrics/json_log.h"

#include <cstddef>
#include <nlohmann/json.hpp>

namespace duet::server::metrics {
namespace {

using Json = nlohmann::ordered_json;

// Failures of the server are errors; mistakes of callers are not.
Severity SeverityOf(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kInternal:
    case absl::StatusCode::kUnknown:
    case absl::StatusCode::kDataLoss:
      return Severity::kError;
    case absl::StatusCode::kResourceExhausted:
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kDeadlineExceeded:
      return Severity::kWarning;
    default:
      return Severity::kInfo;
  }
}

std::string_view Name(Severity severity) {
  switch (severity) {
    case Severity::kInfo:
      return "INFO";
    case Severity::kWarning:
      return "WARNING";
    case Severity::kError:
      break;
  }
  return "ERROR";
}

// In a traceparent, 00-<trace id>-<span id>-<flags>.
constexpr std::size_t kTraceIdAt = 3, kTraceIdSize = 32;

double ToSeconds(absl::Time time) { return absl::ToDoubleSeconds(time - absl::UnixEpoch()); }

std::string Line(absl::Time now, Severity severity, std::string_view event, const Json& fields) {
  Json line;
  line["time"] = absl::FormatTime("%Y-%m-%dT%H:%M:%E6SZ", now, absl::UTCTimeZone());
  line["severity"] = Name(severity);
  line["event"] = event;
  if (fields.is_object()) line.update(fields);
  // Callers can send any bytes; a log line is always valid UTF-8.
  return line.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

JsonLog::~JsonLog() { TellUnlogged(); }

void JsonLog::CallFinished(const CallRecord& record) {
  const Severity severity = SeverityOf(record.status.code());
  if (!IsWanted(record, severity)) return;
  Json fields;
  fields["method"] = record.method.name;
  fields["request_id"] = record.request_id;
  if (!record.traceparent.empty()) {
    fields["traceparent"] = record.traceparent;
    fields["trace_id"] = record.traceparent.substr(kTraceIdAt, kTraceIdSize);
  }
  fields["peer"] = record.peer;
  if (!record.caller.empty()) fields["caller"] = record.caller;
  fields["code"] = absl::StatusCodeToString(record.status.code());
  if (!record.status.ok()) fields["message"] = std::string(record.status.message());
  if (!record.cause.empty()) fields["cause"] = record.cause;
  if (!record.model.empty()) {
    fields["model"] = record.model;
    fields["version"] = record.version;
  }
  if (!record.priority.empty()) {
    fields["priority"] = record.priority;
    fields["seed"] = record.seed;
    fields["variety"] = record.variety;
    fields["candidates"] = record.candidates;
    fields["clean_up"] = record.clean_up;
    fields["frames"] = record.frames;
    fields["chunks"] = record.chunks;
    fields["windows"] = record.totals.windows;
    fields["peak_buffered_frames"] = record.totals.peak_buffered_frames;
    if (record.first_chunk_seconds >= 0) {
      fields["first_chunk_seconds"] = record.first_chunk_seconds;
    }
    if (record.unfamiliarity) fields["unfamiliarity"] = *record.unfamiliarity;
    fields["queue_seconds"] = record.totals.queue_seconds;
    fields["compute_seconds"] = record.totals.compute_seconds;
  }
  fields["total_seconds"] = record.total_seconds;
  Write(severity, "call", fields);
}

bool JsonLog::IsWanted(const CallRecord& record, Severity severity) {
  if (severity < options_.level) return false;
  return record.status.ok() || severity == Severity::kError ||
         filter_.LogRefusal(static_cast<int>(record.status.code()), ToSeconds(now_()));
}

void JsonLog::TellUnlogged() {
  for (const CallLogFilter::Unlogged& calls : filter_.TakeUnlogged()) {
    if (calls.code == CallLogFilter::kLibraries) {
      Write(Severity::kWarning, "library_lines_not_logged", {{"lines", calls.calls}});
      continue;
    }
    const auto code = static_cast<absl::StatusCode>(calls.code);
    Write(SeverityOf(code), "calls_not_logged",
          {{"code", absl::StatusCodeToString(code)}, {"calls", calls.calls}});
  }
}

void JsonLog::Audit(const CallRecord& call, const absl::Status& status,
                    const std::vector<std::pair<std::string, std::string>>& arguments) {
  Json fields = {{"caller", call.caller},
                 {"peer", call.peer},
                 {"request_id", call.request_id},
                 {"action", call.method.name}};
  for (const auto& [key, value] : arguments) fields["arguments"][key] = value;
  fields["code"] = absl::StatusCodeToString(status.code());
  if (!status.ok()) fields["message"] = std::string(status.message());
  sink_.Write(Line(now_(), Severity::kInfo, "admin_action", fields));
}

void JsonLog::Library(std::string_view library, Severity severity, const std::string& message) {
  if (severity < options_.level) return;
  if (!filter_.LogRefusal(CallLogFilter::kLibraries, ToSeconds(now_()))) return;
  TellUnlogged();
  Write(severity, "library", {{"library", library}, {"message", message}});
}

void JsonLog::Info(std::string_view event, Json fields) { Write(Severity::kInfo, event, fields); }

void JsonLog::Warning(std::string_view event, Json fields) {
  Write(Severity::kWarning, event, fields);
}

void JsonLog::Error(std::string_view event, Json fields) { Write(Severity::kError, event, fields); }

void JsonLog::Write(Severity severity, std::string_view event, const Json& fields) {
  if (severity < options_.level) return;
  sink_.Write(Line(now_(), severity, event, fields));
}

}  // namespace duet::server::metrics
