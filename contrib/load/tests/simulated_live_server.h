#ifndef DUET_TESTS_CLIENT_LOAD_SIMULATED_LIVE_SERVER_H_
#define DUET_TESTS_CLIENT_LOAD_SIMULATED_LIVE_SERVER_H_

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "contrib/load/live_target.h"
#include "contrib/load/time.h"

namespace duet::contrib::load {

// A server that answers every leader frame, and those missing before it, a time after it was sent,
// in a time of its own that passes when somebody waits.
class SimulatedLiveServer final : public LiveTarget {
 public:
  // What a test may set before it begins.
  std::function<Duration(int session, int frame)> latency = [](int, int) { return Seconds(0.005); };
  int max_sessions = std::numeric_limits<int>::max();  // further ones are refused
  std::set<int> forgets, repeats;  // frames that are not sent; that are sent twice
  int breaks_at = -1;              // the first session breaks at this frame
  bool never_ends = false;         // until it is cancelled

  // What it saw.
  std::map<int, std::vector<std::pair<Time, int>>> frames;  // of each session

  Time Now() const override { return now_; }

  void Open(int session) override {
    next_[session] = 0;
    if (static_cast<int>(next_.size()) > max_sessions) {
      End(session, now_, absl::StatusCode::kResourceExhausted);
    }
  }

  void Send(int session, int frame) override {
    if (ended_.count(session) > 0) return;
    frames[session].emplace_back(now_, frame);
    const Time at = std::max(last_[session], now_ + latency(session, frame));
    last_[session] = at;
    if (session == 0 && frame == breaks_at) return End(session, at, absl::StatusCode::kUnavailable);
    for (int& next = next_[session]; next <= frame; ++next) {
      if (forgets.count(next) == 0) Answer(session, next, at);
      if (repeats.count(next) > 0) Answer(session, next, at);
    }
  }

  void Finish(int session) override {
    if (!never_ends) End(session, std::max(last_[session], now_), absl::StatusCode::kOk);
  }

  std::vector<LiveEvent> Wait(Time until) override {
    if (!events_.empty()) until = std::min(until, events_.begin()->first);
    now_ = std::max(now_, until);
    std::vector<LiveEvent> arrived;
    while (!events_.empty() && events_.begin()->first <= now_) {
      arrived.push_back(events_.begin()->second);
      events_.erase(events_.begin());
    }
    return arrived;
  }

  void CancelAll() override {
    for (const auto& [session, next] : next_) End(session, now_, absl::StatusCode::kCancelled);
  }

 private:
  void Answer(int session, int frame, Time at) {
    events_.emplace(at, LiveEvent{session, at, frame, 1, 0.002, {}});
  }
  void End(int session, Time at, absl::StatusCode code) {
    if (!ended_.insert(session).second) return;
    events_.emplace(at, LiveEvent{session, at, 0, 0, 0, EndedSession{code, 3, 2, 1}});
  }

  Time now_;
  std::map<int, int> next_;  // the next follower frame of each session
  std::map<int, Time> last_;
  std::set<int> ended_;
  std::multimap<Time, LiveEvent> events_;
};

}  // namespace duet::contrib::load

#endif  // DUET_TESTS_CLIENT_LOAD_SIMULATED_LIVE_SERVER_H_
