#ifndef DUET_SERVER_METRICS_LOG_SINK_H_
#define DUET_SERVER_METRICS_LOG_SINK_H_

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <string_view>

#include "server/common/mutex.h"

namespace duet::server::metrics {

// Takes finished log lines.
//
// Threads: safe to call concurrently.
class LogSink {
 public:
  virtual ~LogSink() = default;
  // `line` ends without a newline. False when it is lost.
  virtual bool Write(std::string_view line) = 0;
  // Lines that were lost so far.
  virtual std::uint64_t dropped_lines() const { return 0; }
};

// Writes each line to a C stream whole, in one write. Waits while the stream takes no more. A line
// that the stream refuses, as on a full disk, is lost; after one that it took in part the next
// begins on a line of its own.
class StreamLogSink final : public LogSink {
 public:
  // `stream` outlives the sink, has not been used yet unless it is standard error, and gets no
  // buffer.
  explicit StreamLogSink(std::FILE* stream);
  bool Write(std::string_view line) override;
  std::uint64_t dropped_lines() const override { return dropped_; }

 private:
  std::FILE* const stream_;
  common::Mutex mutex_;
  bool torn_ DUET_GUARDED_BY(mutex_) = false;  // the stream ends within a line
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_LOG_SINK_H_
