#ifndef DUET_SERVER_METRICS_JSON_LOG_H_
#define DUET_SERVER_METRICS_JSON_LOG_H_

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "absl/time/time.h"
#include "server/metrics/call_record.h"
#include "server/metrics/log_sink.h"

namespace duet::server::metrics {

// The line that says how many log lines were given up (QueuedLogSink's drop_notice).
std::string DroppedLinesNotice(std::uint64_t dropped, absl::Time now = absl::Now());

// One line of JSON for each call and each event of the server's life.
//
//   {"time":"2022-05-01T12:00:00.123Z","severity":"INFO","event":"call","method":"Synthesize",
//    "request_id":"...","code":"OK","frames":300,...}
//
// Threads: safe to call concurrently.
class JsonLog final : public CallObserver {
 public:
  // `sink` outlives the log.
  explicit JsonLog(LogSink& sink, std::function<absl::Time()> now = absl::Now)
      : sink_(sink), now_(std::move(now)) {}

  void CallStarted(const MethodInfo&) override {}
  void CallFinished(const CallRecord& record) override;

  // An event of the server's life: `event` is a stable snake_case name, `fields` an object.
  void Info(std::string_view event, nlohmann::ordered_json fields);
  void Error(std::string_view event, nlohmann::ordered_json fields);

 private:
  void Write(std::string_view severity, std::string_view event,
             const nlohmann::ordered_json& fields);

  LogSink& sink_;
  const std::function<absl::Time()> now_;
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_JSON_LOG_H_
