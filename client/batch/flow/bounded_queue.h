#ifndef DUET_CLIENT_BATCH_FLOW_BOUNDED_QUEUE_H_
#define DUET_CLIENT_BATCH_FLOW_BOUNDED_QUEUE_H_

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <iterator>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace duet::client::batch::flow {

// Hands values from threads to threads; who puts waits while it is full.
//
// Threads: safe to call concurrently.
template <typename Value>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

  // False after Stop: the value is not taken.
  bool Put(Value value) {
    std::unique_lock<std::mutex> lock(mutex_);
    has_room_.wait(lock, [this] { return stopped_ || values_.size() < capacity_; });
    if (stopped_) return false;
    values_.push_back(std::move(value));
    has_values_.notify_one();
    return true;
  }

  // Nothing after Stop, and after Close once it is empty.
  std::optional<Value> Take() {
    std::unique_lock<std::mutex> lock(mutex_);
    has_values_.wait(lock, [this] { return stopped_ || closed_ || !values_.empty(); });
    if (stopped_ || values_.empty()) return std::nullopt;
    std::optional<Value> value(std::move(values_.front()));
    values_.pop_front();
    has_room_.notify_one();
    return value;
  }

  // Everything there is, one at least; empty as Take has nothing.
  std::vector<Value> TakeAll() {
    std::unique_lock<std::mutex> lock(mutex_);
    has_values_.wait(lock, [this] { return stopped_ || closed_ || !values_.empty(); });
    std::vector<Value> all;
    if (stopped_) return all;
    all.assign(std::make_move_iterator(values_.begin()), std::make_move_iterator(values_.end()));
    values_.clear();
    has_room_.notify_all();
    return all;
  }

  // Nothing more will be put.
  void Close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
    has_values_.notify_all();
  }
  // What is in it is dropped.
  void Stop() {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    values_.clear();
    has_values_.notify_all();
    has_room_.notify_all();
  }

 private:
  const std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable has_values_, has_room_;
  std::deque<Value> values_;
  bool closed_ = false;
  bool stopped_ = false;
};

}  // namespace duet::client::batch::flow

#endif  // DUET_CLIENT_BATCH_FLOW_BOUNDED_QUEUE_H_
