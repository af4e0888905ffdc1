#ifndef DUET_SERVER_METRICS_TEXT_LOG_SINK_H_
#define DUET_SERVER_METRICS_TEXT_LOG_SINK_H_

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "server/metrics/log_sink.h"

namespace duet::server::metrics {

// A line of the JSON log as people read it; a line of another kind as it is.
//
//   2022-05-01T12:00:00.123456Z INFO    call method=Synthesize code=OK frames=300
std::string ToText(std::string_view json_line);

// Hands on every line as text. Belongs before the sink that writes and behind the queue, so that
// calls do not wait for it.
//
// Threads: as the sink that it hands on to.
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
