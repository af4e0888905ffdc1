#include "server/metrics/json_log.h"

#include <algorithm>
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

// Unquoted if the end of the value is unambiguous, otherwise as JSON.
std::string ValueText(const Json& value) {
  if (!value.is_string()) return value.dump();
  const std::string text = value.get<std::string>();
  const bool bare = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return c > ' ' && c < 0x7f && c != '"' && c != '=';
  });
  return bare ? text : value.dump();
}

std::string Word(const Json& line, const char* key) {
  const auto found = line.find(key);
  return found == line.end() || !found->is_string() ? "" : found->get<std::string>();
}

}  // namespace

std::string DroppedLinesNotice(std::uint64_t dropped, absl::Time now) {
  return Line(now, Severity::kWarning, "log_lines_dropped", {{"dropped", dropped}});
}

JsonLog::~JsonLog() { TellUnlogged(); }

void JsonLog::CallFinished(const CallRecord& record) {
  const Severity severity = SeverityOf(record.status.code());
  if (!IsWanted(record, severity)) return;
  Json fields;
  fields["method"] = record.method.name;
  fields["request_id"] = record.request_id;
  if (!record.traceparent.empty()) fields["traceparent"] = record.traceparent;
  if (!record.trace.trace_id.empty()) {
    fields["trace_id"] = record.trace.trace_id;
    fields["span_id"] = record.trace.span_id;
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
    fields["windows"] = record.windows;
    fields["peak_buffered_frames"] = record.peak_buffered_frames;
    if (record.first_chunk_seconds >= 0) {
      fields["first_chunk_seconds"] = record.first_chunk_seconds;
    }
    if (record.unfamiliarity) fields["unfamiliarity"] = *record.unfamiliarity;
    fields["queue_seconds"] = record.queue_seconds;
    fields["compute_seconds"] = record.compute_seconds;
  }
  fields["total_seconds"] = record.total_seconds;
  if (record.status.ok() && options_.success_ratio < 1) {
    fields["sampled_ratio"] = options_.success_ratio;
  }
  Write(severity, "call", fields);
}

bool JsonLog::IsWanted(const CallRecord& record, Severity severity) {
  if (severity < options_.level) return false;
  if (record.status.ok()) return filter_.LogSuccess();
  return severity == Severity::kError ||
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

void JsonLog::Audit(const AdminAction& action) {
  Json fields = {{"caller", action.caller},
                 {"peer", action.peer},
                 {"request_id", action.request_id},
                 {"action", action.action}};
  for (const auto& [key, value] : action.arguments) fields["arguments"][key] = value;
  fields["code"] = absl::StatusCodeToString(action.status.code());
  if (!action.status.ok()) fields["message"] = std::string(action.status.message());
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

std::string ToText(std::string_view json_line) {
  constexpr std::size_t kSeverityWidth = 7;  // WARNING
  const Json line = Json::parse(json_line, nullptr, /*allow_exceptions=*/false);
  if (!line.is_object()) return std::string(json_line);
  std::string severity = Word(line, "severity");
  severity.resize(std::max(severity.size(), kSeverityWidth), ' ');
  std::string text = Word(line, "time") + " " + severity + " " + Word(line, "event");
  for (const auto& [key, value] : line.items()) {
    if (key == "time" || key == "severity" || key == "event") continue;
    text += " " + key + "=" + ValueText(value);
  }
  return text;
}

}  // namespace duet::server::metrics
