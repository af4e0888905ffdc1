#ifndef DUET_SERVER_TRACING_SPAN_QUEUE_H_
#define DUET_SERVER_TRACING_SPAN_QUEUE_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "server/common/mutex.h"
#include "server/common/trace_context.h"

namespace duet::server::tracing {

using AttributeValue = std::variant<std::string, std::int64_t, double, bool>;

// A finished call. Times are nanoseconds since 1970.
struct Span {
  common::TraceContext trace;
  std::string name;  // "duet.v1.MotionSynthesis/Synthesize"
  std::int64_t start = 0;
  std::int64_t end = 0;
  std::vector<std::pair<std::string, AttributeValue>> attributes;
  std::vector<std::pair<std::int64_t, std::string>> events;  // time, name
  bool failed = false;                                       // by an error of the server
  std::string message;                                       // the error, if failed
};

// Sends spans in batches from a thread of its own, so that Add never blocks. Spans are dropped and
// counted if the queue is full or they cannot be sent.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil.
class SpanQueue {
 public:
  struct Options {
    std::size_t capacity = 2048;   // waiting spans
    std::size_t batch_size = 512;  // maximum; a full batch is sent at once
    std::chrono::milliseconds interval = std::chrono::seconds(2);  // between smaller batches
    // Sends a batch and returns whether that succeeded. May take seconds. Required.
    std::function<bool(const std::vector<Span>&)> send;
  };

  explicit SpanQueue(Options options);
  // Sends the remaining spans, once.
  ~SpanQueue();
  SpanQueue(const SpanQueue&) = delete;
  SpanQueue& operator=(const SpanQueue&) = delete;

  void Add(Span span);

  std::uint64_t sent() const;
  std::uint64_t dropped() const;

 private:
  void Run();
  // Waits for a batch. An empty one ends the thread.
  std::vector<Span> Next();

  const Options options_;
  mutable common::Mutex mutex_;
  common::CondVar changed_;
  std::vector<Span> spans_ DUET_GUARDED_BY(mutex_);
  std::uint64_t sent_ DUET_GUARDED_BY(mutex_) = 0;
  std::uint64_t dropped_ DUET_GUARDED_BY(mutex_) = 0;
  bool closed_ DUET_GUARDED_BY(mutex_) = false;
  std::thread thread_;  // the last member: it uses the others
};

}  // namespace duet::server::tracing

#endif  // DUET_SERVER_TRACING_SPAN_QUEUE_H_
