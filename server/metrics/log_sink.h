#ifndef DUET_SERVER_METRICS_LOG_SINK_H_
#define DUET_SERVER_METRICS_LOG_SINK_H_

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <string_view>

#include "server/common/mutex.h"

namespace duet::server::metrics {

// Receives finished log lines.
//
// Threads: safe to call concurrently.
class LogSink {
 public:
  virtual ~LogSink() = default;
  // `line` has no newline at its end. Returns false if the line is lost.
  virtual bool Write(std::string_view line) = 0;
  // Number of lines lost so far.
  virtual std::uint64_t dropped_lines() const { return 0; }
};

// Writes each line to a C stream in one write. Blocks while the stream accepts no data. A line that
// the stream rejects, as on a full disk, is lost. After a partly written line, the next one starts
// on a new line.
class StreamLogSink final : public LogSink {
 public:
  // `stream` outlives the sink and has not been used yet, unless it is standard error. It becomes
  // unbuffered.
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
