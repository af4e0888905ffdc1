#ifndef DUET_SERVER_METRICS_JSON_LOG_H_
#define DUET_SERVER_METRICS_JSON_LOG_H_

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "absl/time/time.h"
#include "server/metrics/admin_action.h"
#include "server/metrics/call_log_filter.h"
#include "server/metrics/call_record.h"
#include "server/metrics/log_sink.h"

namespace duet::server::metrics {

// How grave a line is.
enum class Severity { kInfo, kWarning, kError };

// What is worth a line.
struct LogOptions {
  Severity level = Severity::kInfo;  // lines below it are left out
  double success_ratio = 1;          // of successful calls, 0 to 1
  int refusals_per_second = 10;      // of each status code; beyond, a line a second says how many
};

// The line that says how many log lines were given up (QueuedLogSink's drop_notice).
std::string DroppedLinesNotice(std::uint64_t dropped, absl::Time now = absl::Now());

// One line of JSON for each call and each event of the server's life.
//
//   {"time":"2022-05-01T12:00:00.123Z","severity":"INFO","event":"call","method":"Synthesize",
//    "request_id":"...","code":"OK","frames":300,...}
//
// A server's own failures always have a line; for other calls see LogOptions. Calls that got none
// are told by "calls_not_logged" {code, calls}; libraries' lines by "library_lines_not_logged"
// {lines}.
//
// Threads: safe to call concurrently.
class JsonLog final : public CallObserver {
 public:
  // `sink` outlives the log.
  explicit JsonLog(LogSink& sink, std::function<absl::Time()> now = absl::Now,
                   const LogOptions& options = {})
      : sink_(sink),
        now_(std::move(now)),
        options_(options),
        filter_(options.success_ratio, options.refusals_per_second) {}
  // Tells of the calls that were not logged yet.
  ~JsonLog() override;

  void CallStarted(const MethodInfo&) override {}
  void CallFinished(const CallRecord& record) override;

  // Tells of calls that got no line since it was called last. Call about once a second.
  void TellUnlogged();

  // An administrator's doing, which has a line whatever the options say.
  void Audit(const AdminAction& action);

  // What a library has to say, such as gRPC of a handshake that failed: a client can cause any
  // number of those. As with refused calls, some a second have a line.
  void Library(std::string_view library, Severity severity, const std::string& message);

  // An event of the server's life: `event` is a stable snake_case name, `fields` an object.
  void Info(std::string_view event, nlohmann::ordered_json fields);
  void Warning(std::string_view event, nlohmann::ordered_json fields);
  void Error(std::string_view event, nlohmann::ordered_json fields);

 private:
  bool IsWanted(const CallRecord& record, Severity severity);
  void Write(Severity severity, std::string_view event, const nlohmann::ordered_json& fields);

  LogSink& sink_;
  const std::function<absl::Time()> now_;
  const LogOptions options_;
  CallLogFilter filter_;
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_JSON_LOG_H_
