#ifndef DUET_SERVER_METRICS_JSON_LOG_H_
#define DUET_SERVER_METRICS_JSON_LOG_H_

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "server/metrics/call_record.h"
#include "server/metrics/log_sink.h"

namespace duet::server::metrics {

enum class Severity { kInfo, kWarning, kError };

// Selects the lines to log.
struct LogOptions {
  Severity level = Severity::kInfo;  // minimum severity
  int refusals_per_second = 10;      // for each status code; the rest is counted
};

// Writes one line of JSON for each call and for each event of the server.
//
//   {"time":"2022-05-01T12:00:00.123Z","severity":"INFO","event":"call","method":"Synthesize",
//    "request_id":"...","code":"OK","frames":300,...}
//
// Failures of the server itself are always logged; for other calls see LogOptions. The event
// "calls_not_logged" {code, calls} counts calls that were not logged, "library_lines_not_logged"
// {lines} the messages of libraries.
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
        filter_(options.refusals_per_second) {}
  // Reports the calls that were not logged.
  ~JsonLog() override;

  void CallStarted(const MethodInfo&) override {}
  void CallFinished(const CallRecord& record) override;

  // Reports the calls that were not logged since the previous call. Call it about once a second.
  void TellUnlogged();

  // Logs a call of an administrator, successful or not, whatever the options are. `arguments`: of
  // the request, {"model", "sbu"} and so on.
  void Audit(const CallRecord& call, const absl::Status& status,
             const std::vector<std::pair<std::string, std::string>>& arguments);

  // Logs a message of a library, such as gRPC's about a failed handshake. Clients can cause any
  // number of those, so they are limited per second like rejected calls.
  void Library(std::string_view library, Severity severity, const std::string& message);

  // Logs an event of the server. `event` is a stable snake_case name, `fields` an object.
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
