#ifndef DUET_SERVER_BATCHING_WINDOW_QUEUE_H_
#define DUET_SERVER_BATCHING_WINDOW_QUEUE_H_

#include <cstddef>
#include <deque>
#include <optional>

#include "server/batching/window_scheduler.h"

namespace duet::server::batching {

// A job and when it came.
struct QueuedWindow {
  WindowJob job;
  common::TimePoint queued_at;
};

// Two first-in first-out lines; interactive goes first. Since a call has one window in line at a
// time, calls of the same priority take turns.
//
// Threads: not safe to call concurrently.
class WindowQueue {
 public:
  // `capacity`: waiting windows above which no new call is taken, 1 or more.
  explicit WindowQueue(std::size_t capacity) : capacity_(capacity) {}

  // True when a job like this may join: a further window of a call always; a call's first one while
  // fewer windows wait, of whatever priority, than its own priority's share of the capacity.
  bool HasRoomFor(const WindowJob& job) const;
  void Push(QueuedWindow window);
  // The next window to start; nothing when empty.
  std::optional<QueuedWindow> Pop();

  std::size_t size() const { return interactive_.size() + bulk_.size(); }
  std::size_t capacity() const { return capacity_; }

 private:
  std::size_t capacity_;
  std::deque<QueuedWindow> interactive_;
  std::deque<QueuedWindow> bulk_;
};

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_WINDOW_QUEUE_H_
