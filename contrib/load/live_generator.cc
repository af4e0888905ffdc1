#include "contrib/load/live_generator.h"

#include <algorithm>
#include <cstddef>
#include <queue>
#include <tuple>
#include <vector>

#include "contrib/load/live_recorder.h"
#include "contrib/load/live_schedule.h"

namespace duet::contrib::load {
namespace {

constexpr Duration kLongestWait = std::chrono::milliseconds(200);  // between checks of `stopped`

class LiveGenerator {
 public:
  LiveGenerator(const LiveOptions& options, LiveTarget& target)
      : options_(options),
        target_(target),
        begin_(target.Now()),
        measured_from_(begin_ + options.warm_up),
        end_(measured_from_ + options.measured),
        recorder_(options, measured_from_) {
    for (int i = 0; i < options.sessions; ++i) {
      sessions_.push_back({LiveSchedule(options, i, begin_), {}, false, false});
      due_.push({sessions_.back().schedule.opens(), i});
    }
  }

  LiveMeasurement Run() {
    while (!IsOver()) {
      SendWhatIsDue();
      Time next = std::min(end_, target_.Now() + kLongestWait);
      if (!due_.empty()) next = std::min(next, due_.top().time);
      TakeUntil(next);
    }
    const Time end = std::min(end_, target_.Now());
    EndSessions();
    return recorder_.Finish(std::max(0.0, ToSeconds(end - measured_from_)));
  }

 private:
  struct Session {
    LiveSchedule schedule;
    LiveSchedule::Frame next;
    bool open, ended;
  };
  struct Due {
    Time time;
    int session;
    bool operator<(const Due& other) const {  // the earliest is on top
      return std::tie(other.time, other.session) < std::tie(time, session);
    }
  };

  bool IsOver() { return target_.Now() >= end_ || (options_.stopped && options_.stopped()); }

  void SendWhatIsDue() {
    while (!due_.empty() && due_.top().time <= target_.Now()) {
      const int index = due_.top().session;
      due_.pop();
      Session& session = sessions_[static_cast<std::size_t>(index)];
      if (session.ended) continue;
      if (!session.open) {
        Open(index, &session);
      } else {
        Send(index, &session);
      }
      due_.push({session.next.due, index});
    }
  }

  void Open(int index, Session* session) {
    session->open = true;
    ++open_;
    recorder_.Opened(index, target_.Now());
    target_.Open(index);
    session->next = session->schedule.Next();
  }

  void Send(int index, Session* session) {
    recorder_.Sent(index, session->next, target_.Now());
    if (!session->next.lost) target_.Send(index, session->next.index);
    session->next = session->schedule.Next();
  }

  void TakeUntil(Time until) {
    for (const LiveEvent& event : target_.Wait(until)) {
      recorder_.Arrived(event);
      if (!event.ended) continue;
      sessions_[static_cast<std::size_t>(event.session)].ended = true;
      --open_;
    }
  }

  // Lets the server answer what it has, and cancels the sessions that it does not end in time.
  void EndSessions() {
    for (std::size_t i = 0; i < sessions_.size(); ++i) {
      if (sessions_[i].open && !sessions_[i].ended) target_.Finish(static_cast<int>(i));
    }
    const Time last = target_.Now() + options_.longest_end;
    while (open_ > 0 && target_.Now() < last) TakeUntil(last);
    target_.CancelAll();
    while (open_ > 0) TakeUntil(target_.Now() + kLongestWait);
  }

  const LiveOptions& options_;
  LiveTarget& target_;
  const Time begin_, measured_from_, end_;
  LiveRecorder recorder_;
  std::vector<Session> sessions_;
  std::priority_queue<Due> due_;
  int open_ = 0;
};

}  // namespace

LiveMeasurement RunLive(const LiveOptions& options, LiveTarget& target) {
  return LiveGenerator(options, target).Run();
}

}  // namespace duet::contrib::load
