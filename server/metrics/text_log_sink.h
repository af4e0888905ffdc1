#ifndef DUET_SERVER_METRICS_TEXT_LOG_SINK_H_
#define DUET_SERVER_METRICS_TEXT_LOG_SINK_H_

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "server/metrics/log_sink.h"

namespace duet::server::metrics {

// Formats a line of the JSON log for people. Returns any other line unchanged.
//
//   2022-05-01T12:00:00.123456Z INFO    call method=Synthesize code=OK frames=300
std::string ToText(std::string_view json_line);

// Passes every line on as text. Put it between the queue and the sink that writes, so that calls do
// not wait for it.
//
// Threads: like the sink that it passes lines to.
class TextLogSink final : public LogSink {
 public:
  explicit TextLogSink(std::shared_ptr<LogSink> sink) : sink_(std::move(sink)) {}
  bool Write(std::string_view line) override { return sink_->Write(ToText(line)); }
  std::uint64_t dropped_lines() const override { return sink_->dropped_lines(); }

 private:
  const std::shared_ptr<LogSink> sink_;
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_TEXT_LOG_SINK_H_
