#include "server/batching/window_queue.h"

#include <utility>

namespace duet::server::batching {

bool WindowQueue::HasRoomFor(const WindowJob& job) const {
  if (job.continues_call) return true;
  return size() < ShareOf(capacity_, job.priority);
}

void WindowQueue::Push(QueuedWindow window) {
  std::deque<QueuedWindow>& line = window.job.priority == Priority::kBulk ? bulk_ : interactive_;
  line.push_back(std::move(window));
}

std::optional<QueuedWindow> WindowQueue::Pop() {
  std::deque<QueuedWindow>& line = interactive_.empty() ? bulk_ : interactive_;
  if (line.empty()) return std::nullopt;
  QueuedWindow next = std::move(line.front());
  line.pop_front();
  return next;
}

}  // namespace duet::server::batching
