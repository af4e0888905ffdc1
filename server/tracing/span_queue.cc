#include "server/tracing/span_queue.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace duet::server::tracing {

SpanQueue::SpanQueue(Options options) : options_(std::move(options)), thread_([this] { Run(); }) {}

SpanQueue::~SpanQueue() {
  {
    common::MutexLock lock(mutex_);
    closed_ = true;
  }
  changed_.NotifyAll();
  thread_.join();
}

void SpanQueue::Add(Span span) {
  bool full_batch = false;
  {
    common::MutexLock lock(mutex_);
    if (spans_.size() >= options_.capacity) {
      ++dropped_;
      return;
    }
    spans_.push_back(std::move(span));
    full_batch = spans_.size() >= options_.batch_size;
  }
  if (full_batch) changed_.NotifyAll();
}

std::uint64_t SpanQueue::sent() const {
  common::MutexLock lock(mutex_);
  return sent_;
}

std::uint64_t SpanQueue::dropped() const {
  common::MutexLock lock(mutex_);
  return dropped_;
}

std::vector<Span> SpanQueue::Next() {
  common::MutexLock lock(mutex_);
  while (true) {
    const auto end = std::chrono::steady_clock::now() + options_.interval;
    while (!closed_ && spans_.size() < options_.batch_size && changed_.WaitUntil(mutex_, end)) {
    }
    if (!spans_.empty() || closed_) break;
  }
  const auto last =
      spans_.begin() + static_cast<std::ptrdiff_t>(std::min(options_.batch_size, spans_.size()));
  std::vector<Span> batch(std::make_move_iterator(spans_.begin()), std::make_move_iterator(last));
  spans_.erase(spans_.begin(), last);
  return batch;
}

void SpanQueue::Run() {
  for (std::vector<Span> batch = Next(); !batch.empty(); batch = Next()) {
    const bool sent = options_.send(batch);
    common::MutexLock lock(mutex_);
    (sent ? sent_ : dropped_) += batch.size();
    // An unreachable collector must not delay the exit of the server.
    if (!sent && closed_) {
      dropped_ += std::exchange(spans_, {}).size();
      return;
    }
  }
}

}  // namespace duet::server::tracing
