#ifndef DUET_SERVER_METRICS_QUEUED_LOG_SINK_H_
#define DUET_SERVER_METRICS_QUEUED_LOG_SINK_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include "server/metrics/log_sink.h"

namespace duet::server::metrics {

// Puts a bounded queue and a thread before a sink that may be slow or stuck, such as a pipe without
// a reader, so that Write never blocks. Lines are dropped and counted if the queue is full or the
// sink loses them. A line that reports their number follows as soon as the sink accepts lines
// again.
//
//   QueuedLogSink log(std::make_shared<StreamLogSink>(stderr), options);
//   ... log.Write(line) from any thread ...
//   // The destructor writes the remaining lines.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil.
class QueuedLogSink final : public LogSink {
 public:
  struct Options {
    std::size_t capacity = 4096;  // waiting lines, 1 or more
    // Maximum time that the destructor waits for a stuck sink before it drops the remaining lines.
    std::chrono::milliseconds patience = std::chrono::seconds(5);
    // The line that reports lost lines. Required; called on the writing thread.
    std::function<std::string(std::uint64_t dropped)> drop_notice;
  };

  // Shares the sink, because a thread that is stuck in the sink outlives this object.
  QueuedLogSink(std::shared_ptr<LogSink> sink, const Options& options);
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

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_QUEUED_LOG_SINK_H_
