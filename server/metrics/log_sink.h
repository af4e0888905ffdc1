#ifndef DUET_SERVER_METRICS_LOG_SINK_H_
#define DUET_SERVER_METRICS_LOG_SINK_H_

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace duet::server::metrics {

// Takes finished log lines.
//
// Threads: safe to call concurrently.
class LogSink {
 public:
  virtual ~LogSink() = default;
  // `line` ends without a newline.
  virtual void Write(std::string_view line) = 0;
  // Lines that were given up so far.
  virtual std::uint64_t dropped_lines() const { return 0; }
};

// Writes each line to a C stream whole, in one write. Waits while the stream takes no more.
class StreamLogSink final : public LogSink {
 public:
  explicit StreamLogSink(std::FILE* stream) : stream_(stream) {}
  void Write(std::string_view line) override;

 private:
  std::FILE* const stream_;
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_LOG_SINK_H_
