#include "contrib/load/live.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <queue>
#include <tuple>
#include <utility>

namespace duet::contrib::load {
namespace {

constexpr uint64_t kSeed = 0;
constexpr double kOpeningSeconds = 1;
constexpr Duration kMissedAfter = std::chrono::milliseconds(100);
constexpr Duration kLongestWait = std::chrono::milliseconds(200);  // between checks of `stopped`
constexpr Duration kLongestEnd = std::chrono::seconds(5);  // then open sessions are cancelled

class LiveGenerator {
 public:
  LiveGenerator(const LiveOptions& options, LiveTarget& target)
      : options_(options),
        target_(target),
        begin_(target.Now()),
        measured_from_(begin_ + options.warm_up),
        end_(measured_from_ + options.measured),
        frame_interval_(Seconds(1 / options.frame_rate_hz)) {
    figures_.sessions = options.sessions;
    for (int i = 0; i < options.sessions; ++i) {
      sessions_.emplace_back(LiveSchedule(options, i, begin_));
      due_.push({sessions_.back().schedule.opens(), i});
    }
  }

  LiveFigures Run() {
    while (!IsOver()) {
      SendWhatIsDue();
      Time next = std::min(end_, target_.Now() + kLongestWait);
      if (!due_.empty()) next = std::min(next, due_.top().time);
      TakeUntil(next);
    }
    const Time end = std::min(end_, target_.Now());
    EndSessions();
    figures_.seconds = std::max(0.0, ToSeconds(end - measured_from_));
    return std::move(figures_);
  }

 private:
  struct Session {
    explicit Session(LiveSchedule own) : schedule(std::move(own)) {}

    LiveSchedule schedule;
    LiveSchedule::Frame next;
    bool open = false, ended = false;
    Time opened;
    std::vector<std::optional<Time>> due;  // of each frame so far; absent: lost on purpose
    int received = 0;                      // final frames, without doubled ones
  };
  struct Due {
    Time time;
    int session;
    bool operator<(const Due& other) const {  // the earliest is on top
      return std::tie(other.time, other.session) < std::tie(time, session);
    }
  };

  bool IsOver() { return target_.Now() >= end_ || (options_.stopped && options_.stopped()); }
  bool IsMeasured(Time due) const { return due >= measured_from_ && due < end_; }

  void SendWhatIsDue() {
    while (!due_.empty() && due_.top().time <= target_.Now()) {
      const int index = due_.top().session;
      due_.pop();
      Session& session = sessions_[static_cast<std::size_t>(index)];
      if (session.ended) continue;
      if (session.open) {
        Send(index, &session);
      } else {
        session.open = true;
        session.opened = target_.Now();
        ++open_;
        target_.Open(index);
      }
      session.next = session.schedule.Next();
      due_.push({session.next.due, index});
    }
  }

  void Send(int index, Session* session) {
    const LiveSchedule::Frame& frame = session->next;
    session->due.resize(static_cast<std::size_t>(frame.index) + 1);
    if (frame.lost) return;
    session->due.back() = frame.due;
    if (IsMeasured(frame.due)) {
      ++figures_.sent;
      figures_.late_sent.Add(target_.Now() - frame.due);
    }
    target_.Send(index, frame.index);
  }

  void TakeUntil(Time until) {
    for (const LiveEvent& event : target_.Wait(until)) {
      Session& session = sessions_[static_cast<std::size_t>(event.session)];
      if (event.ended) {
        TakeEnd(&session, *event.ended);
      } else {
        TakeFrames(&session, event);
      }
    }
  }

  void TakeFrames(Session* session, const LiveEvent& event) {
    if (session->received == 0 && event.frames > 0) {
      figures_.first_frame.Add(event.time - session->opened);
    }
    if (IsMeasured(event.time)) figures_.at_server.Add(Seconds(event.server_seconds));
    for (int frame = event.first_frame; frame < event.first_frame + event.frames; ++frame) {
      if (frame < session->received) {
        ++figures_.doubled;
        continue;
      }
      figures_.lost += frame - session->received;
      session->received = frame + 1;
      TakeFrame(*session, static_cast<std::size_t>(frame), event.time);
    }
  }

  void TakeFrame(const Session& session, std::size_t frame, Time time) {
    if (frame >= session.due.size() || !session.due[frame].has_value()) return;
    const Time due = *session.due[frame];
    if (!IsMeasured(due)) return;
    const Duration latency = time - due;
    ++figures_.answered;
    figures_.latency.Add(latency);
    figures_.late += latency > frame_interval_ ? 1 : 0;
    figures_.missed += latency > kMissedAfter ? 1 : 0;
  }

  void TakeEnd(Session* session, const EndedSession& ended) {
    session->ended = true;
    --open_;
    ++figures_.ended[ended.code];
    figures_.skipped += ended.skipped_frames;
    figures_.interpolated += ended.gap_frames;
    figures_.dropped += ended.late_frames;
    const bool failed = ended.code != absl::StatusCode::kOk;
    if (failed && session->received == 0) ++figures_.refused;
    // Frames that never came; of a failed session they are missed, not lost.
    const std::size_t received = static_cast<std::size_t>(session->received);
    for (std::size_t frame = received; frame < session->due.size(); ++frame) {
      if (!session->due[frame].has_value()) continue;
      if (!failed) ++figures_.lost;
      if (IsMeasured(*session->due[frame])) ++figures_.missed;
    }
  }

  // Lets the server answer what it has, and cancels the sessions that it does not end in time.
  void EndSessions() {
    for (std::size_t i = 0; i < sessions_.size(); ++i) {
      if (sessions_[i].open && !sessions_[i].ended) target_.Finish(static_cast<int>(i));
    }
    const Time last = target_.Now() + kLongestEnd;
    while (open_ > 0 && target_.Now() < last) TakeUntil(last);
    target_.CancelAll();
    while (open_ > 0) TakeUntil(target_.Now() + kLongestWait);
  }

  const LiveOptions& options_;
  LiveTarget& target_;
  const Time begin_, measured_from_, end_;
  const Duration frame_interval_;
  LiveFigures figures_;
  std::vector<Session> sessions_;
  std::priority_queue<Due> due_;
  int open_ = 0;
};

}  // namespace

LiveSchedule::LiveSchedule(const LiveOptions& options, int session, Time begin)
    : options_(options), random_(kSeed, session) {
  // Whole frames later than the session before, so that the opening does not decide the phase.
  const double share = static_cast<double>(session) / options.sessions;
  const double frames = std::floor(share * kOpeningSeconds * options.frame_rate_hz);
  const double phase = options.in_step ? 0 : share;
  opens_ = begin + Seconds((frames + phase) / options.frame_rate_hz);
  const Duration room = std::max(Duration{0}, options.measured - options.stall);
  stalls_from_ = begin + options.warm_up + Seconds(random_.Uniform() * ToSeconds(room));
  stalls_until_ = stalls_from_ + options.stall;
  last_due_ = opens_;
}

LiveSchedule::Frame LiveSchedule::Next() {
  Frame frame;
  frame.index = next_++;
  frame.due = opens_ + Seconds(frame.index / options_.frame_rate_hz) +
              Seconds(random_.Uniform() * ToSeconds(options_.jitter));
  if (frame.due >= stalls_from_ && frame.due < stalls_until_) frame.due = stalls_until_;
  frame.due = last_due_ = std::max(last_due_, frame.due);
  frame.lost = random_.Chance(options_.loss) && frame.index > 0;
  return frame;
}

LiveFigures RunLive(const LiveOptions& options, LiveTarget& target) {
  return LiveGenerator(options, target).Run();
}

}  // namespace duet::contrib::load
