#ifndef DUET_SERVER_METRICS_LOG_SINK_H_
#define DUET_SERVER_METRICS_LOG_SINK_H_

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

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

// Puts a bounded queue and a thread before a sink that may be slow or stuck, such as a pipe without
// a reader, so that Write never blocks. Lines are dropped and counted if the queue is full or the
// sink loses them.
//
//   QueuedLogSink log(std::make_shared<StreamLogSink>(stderr));
//   ... log.Write(line) from any thread ...
//   // The destructor writes the remaining lines.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil.
class QueuedLogSink final : public LogSink {
 public:
  // `capacity`: waiting lines, 1 or more. `patience`: maximum time that the destructor waits for a
  // stuck sink before it drops the remaining lines. Shares the sink, because a thread that is stuck
  // in the sink outlives this object.
  explicit QueuedLogSink(std::shared_ptr<LogSink> sink, std::size_t capacity = 4096,
                         std::chrono::milliseconds patience = std::chrono::seconds(5));
  // Writes the remaining lines, as long as the sink accepts them.
  ~QueuedLogSink() override;
  QueuedLogSink(const QueuedLogSink&) = delete;
  QueuedLogSink& operator=(const QueuedLogSink&) = delete;

  bool Write(std::string_view line) override;
  std::uint64_t dropped_lines() const override;

 private:
  class Queue;
  const std::shared_ptr<Queue> queue_;
  const std::chrono::milliseconds patience_;
  std::thread writer_;
};

// Decides which rejected calls are logged, so that a flood of them does not fill the disk: a number
// per second and status code. It counts the others.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil.
class CallLogFilter {
 public:
  // The code for messages of libraries: that of OK, which is never rejected.
  static constexpr int kLibraries = 0;

  // Calls of one status code that were not logged.
  struct Unlogged {
    int code = 0;
    std::uint64_t calls = 0;
  };

  // `refusals_per_second`: at least 0.
  explicit CallLogFilter(int refusals_per_second) : refusals_per_second_(refusals_per_second) {}

  // Whether to log a rejected call. `code`: a gRPC status code, 1 to 16, or kLibraries; `now`: in
  // seconds.
  bool LogRefusal(int code, double now);

  // Returns how many rejected calls were not logged since the previous call of this function, by
  // code.
  std::vector<Unlogged> TakeUnlogged();

 private:
  static constexpr std::size_t kCodes = 17;
  struct Second {
    double begin = 0;
    int logged = 0;
    std::uint64_t unlogged = 0;
  };

  const int refusals_per_second_;
  common::Mutex mutex_;
  std::array<Second, kCodes> seconds_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_LOG_SINK_H_
