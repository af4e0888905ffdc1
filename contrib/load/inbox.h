#ifndef DUET_CONTRIB_LOAD_INBOX_H_
#define DUET_CONTRIB_LOAD_INBOX_H_

#include <condition_variable>
#include <mutex>
#include <utility>
#include <vector>

#include "contrib/load/figures.h"

namespace duet::contrib::load {

// What gRPC's threads report of calls and the generator's thread has not taken yet.
template <typename Event>
class Inbox {
 public:
  void Opened() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++open_;
  }
  void Add(const Event& event, bool is_end) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (is_end) --open_;
    events_.push_back(event);
    changed_.notify_all();
  }
  std::vector<Event> Wait(Time until) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_until(lock, until, [this] { return !events_.empty(); });
    return std::exchange(events_, {});
  }
  void WaitUntilNoneIsOpen() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return open_ == 0; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Event> events_;
  int open_ = 0;
};

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_INBOX_H_
