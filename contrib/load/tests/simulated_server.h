#ifndef DUET_TESTS_CLIENT_LOAD_SIMULATED_SERVER_H_
#define DUET_TESTS_CLIENT_LOAD_SIMULATED_SERVER_H_

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "contrib/load/target.h"
#include "contrib/load/time.h"

namespace duet::contrib::load {

// A server of some workers who take calls in the order in which they come, in a time of its own
// that passes when somebody waits. Calls have 45 frames, the first of them half way.
class SimulatedServer final : public Target {
 public:
  // What a test may set before it begins.
  std::size_t workers = 1;
  std::function<Duration(std::size_t kind)> cost = [](std::size_t) { return Seconds(0.01); };
  int max_calls = std::numeric_limits<int>::max();  // more are refused at once
  // No call begins within this time from the start.
  Duration stands_still_from{0}, stands_still_until{0};

  // What it saw.
  int most_calls = 0;
  std::vector<std::size_t> kinds;
  int cancelled = 0;

  Time Now() const override { return now_; }
  void Advance(Duration time) { now_ += time; }

  void Start(int64_t id, std::size_t kind) override {
    kinds.push_back(kind);
    if (static_cast<int>(open_.size()) >= max_calls) {
      open_.emplace(now_, EndedCall{id, absl::StatusCode::kResourceExhausted, {}, now_, 0});
      return;
    }
    free_.resize(workers, Time());
    Time& worker = *std::min_element(free_.begin(), free_.end());
    Time begin = std::max(now_, worker);
    if (begin >= Time() + stands_still_from && begin < Time() + stands_still_until) {
      begin = Time() + stands_still_until;
    }
    const Duration taken = cost(kind);
    worker = begin + taken;
    open_.emplace(worker, EndedCall{id, absl::StatusCode::kOk, begin + taken / 2, worker, 45});
    most_calls = std::max(most_calls, static_cast<int>(open_.size()));
  }

  std::vector<EndedCall> Wait(Time until) override {
    if (!open_.empty()) until = std::min(until, open_.begin()->first);
    now_ = std::max(now_, until);
    std::vector<EndedCall> ended;
    while (!open_.empty() && open_.begin()->first <= now_) {
      ended.push_back(open_.begin()->second);
      open_.erase(open_.begin());
    }
    return ended;
  }

  void CancelAll() override {
    cancelled = static_cast<int>(open_.size());
    std::multimap<Time, EndedCall> calls = std::exchange(open_, {});
    for (auto& [end, call] : calls) {
      call.code = absl::StatusCode::kCancelled;
      call.end = now_;
      open_.emplace(now_, call);
    }
  }

 private:
  Time now_;
  std::vector<Time> free_;  // when each worker is
  std::multimap<Time, EndedCall> open_;
};

}  // namespace duet::contrib::load

#endif  // DUET_TESTS_CLIENT_LOAD_SIMULATED_SERVER_H_
