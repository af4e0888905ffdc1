#ifndef DUET_CLIENT_BATCH_FLOW_QUEUES_H_
#define DUET_CLIENT_BATCH_FLOW_QUEUES_H_

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace duet::client::batch::flow {

// Passes values between threads.
//
// Threads: safe to call concurrently.
template <typename Value>
class Queue {
 public:
  // `capacity`: maximum total cost of its values.
  explicit Queue(std::size_t capacity) : capacity_(capacity) {}

  // Blocks while the queue is full. Returns false, and drops the value, after Stop. A value that
  // costs more than the capacity waits until the queue is empty.
  bool Put(Value value, std::size_t cost = 1) {
    std::unique_lock<std::mutex> lock(mutex_);
    has_room_.wait(lock, [&] { return stopped_ || values_.empty() || cost_ + cost <= capacity_; });
    if (stopped_) return false;
    values_.push_back({std::move(value), cost});
    cost_ += cost;
    has_values_.notify_one();
    if (HasMuch()) has_much_.notify_one();
    return true;
  }

  // nullopt after Stop, and after Close when all values are taken.
  std::optional<Value> Take() {
    std::unique_lock<std::mutex> lock(mutex_);
    has_values_.wait(lock, [this] { return stopped_ || closed_ || !values_.empty(); });
    if (stopped_ || values_.empty()) return std::nullopt;
    std::optional<Value> value(std::move(values_.front().value));
    cost_ -= values_.front().cost;
    values_.pop_front();
    has_room_.notify_one();
    return value;
  }

  // All values of the next `time`, at least one. Returns earlier if the queue is full or closed.
  // Empty when Take would return nullopt.
  std::vector<Value> Gather(std::chrono::nanoseconds time) {
    std::unique_lock<std::mutex> lock(mutex_);
    has_much_.wait_for(lock, time, [this] { return stopped_ || closed_ || HasMuch(); });
    has_values_.wait(lock, [this] { return stopped_ || closed_ || !values_.empty(); });
    std::vector<Value> all;
    if (stopped_) return all;
    all.reserve(values_.size());
    for (Priced& priced : values_) all.push_back(std::move(priced.value));
    values_.clear();
    cost_ = 0;
    has_room_.notify_all();
    return all;
  }

  // No more new values will be put.
  void Close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
    has_values_.notify_all();
    has_much_.notify_all();
  }
  // Drops all values.
  void Stop() {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    values_.clear();
    cost_ = 0;
    has_values_.notify_all();
    has_much_.notify_all();
    has_room_.notify_all();
  }

 private:
  struct Priced {
    Value value;
    std::size_t cost;
  };
  bool HasMuch() const { return cost_ > capacity_ / 2; }

  const std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable has_values_, has_much_, has_room_;
  std::deque<Priced> values_;
  std::size_t cost_ = 0;
  bool closed_ = false;
  bool stopped_ = false;
};

}  // namespace duet::client::batch::flow

#endif  // DUET_CLIENT_BATCH_FLOW_QUEUES_H_
