#include "server/metrics/json_log.h"

#include <nlohmann/json.hpp>

namespace duet::server::metrics {
namespace {

using Json = nlohmann::ordered_json;

// A server's own failures stand out from what callers did wrong.
std::string_view Severity(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kInternal:
    case absl::StatusCode::kUnknown:
    case absl::StatusCode::kDataLoss:
      return "ERROR";
    case absl::StatusCode::kResourceExhausted:
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kDeadlineExceeded:
      return "WARNING";
    default:
      return "INFO";
  }
}

// One line of the log: when, how grave, what, and its fields.
std::string Line(absl::Time now, std::string_view severity, std::string_view event,
                 const Json& fields) {
  Json line;
  line["time"] = absl::FormatTime("%Y-%m-%dT%H:%M:%E6SZ", now, absl::UTCTimeZone());
  line["severity"] = severity;
  line["event"] = event;
  if (fields.is_object()) line.update(fields);
  // Callers' bytes may be anything; a log line is always valid UTF-8.
  return line.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string DroppedLinesNotice(std::uint64_t dropped, absl::Time now) {
  return Line(now, "WARNING", "log_lines_dropped", {{"dropped", dropped}});
}

void JsonLog::CallFinished(const CallRecord& record) {
  Json fields;
  fields["method"] = record.method.name;
  fields["request_id"] = record.request_id;
  if (!record.traceparent.empty()) fields["traceparent"] = record.traceparent;
  fields["peer"] = record.peer;
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
  Write(Severity(record.status.code()), "call", fields);
}

void JsonLog::Info(std::string_view event, Json fields) { Write("INFO", event, fields); }

void JsonLog::Error(std::string_view event, Json fields) { Write("ERROR", event, fields); }

void JsonLog::Write(std::string_view severity, std::string_view event, const Json& fields) {
  sink_.Write(Line(now_(), severity, event, fields));
}

}  // namespace duet::server::metrics
