#include "contrib/load/live.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <queue>
#include <tuple>
#include <utility>

namespace duet::contrib::load {
namespace {

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
      sessions_.emplace_back().opens = OpeningOf(options, i, begin_);
      due_.push({sessions_.back().opens, i});
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
    Time opens;
    bool open = false, ended = false;
    Time opened;
    int sent = 0;      // leader frames
    int received = 0;  // final frames, without doubled ones
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
      if (!session.open) {
        session.open = true;
        session.opened = target_.Now();
        ++open_;
        target_.Open(index);
      }
      Send(index, &session);
    }
  }

  // When a frame of a session is due to be sent.
  Time DueOf(const Session& session, int frame) const {
    return session.opens + Seconds(frame / options_.frame_rate_hz);
  }

  void Send(int index, Session* session) {
    const Time due = DueOf(*session, session->sent);
    if (IsMeasured(due)) {
      ++figures_.sent;
      figures_.late_sent.Add(target_.Now() - due);
    }
    target_.Send(index, session->sent++);
    due_.push({DueOf(*session, session->sent), index});
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
      TakeFrame(*session, frame, event.time);
    }
  }

  void TakeFrame(const Session& session, int frame, Time time) {
    const Time due = DueOf(session, frame);
    if (frame >= session.sent || !IsMeasured(due)) return;
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
    const bool failed = ended.code != absl::StatusCode::kOk;
    if (failed && session->received == 0) ++figures_.refused;
    // Frames that never came; of a failed session they are missed, not lost.
    for (int frame = session->received; frame < session->sent; ++frame) {
      if (!failed) ++figures_.lost;
      if (IsMeasured(DueOf(*session, frame))) ++figures_.missed;
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

Time OpeningOf(const LiveOptions& options, int session, Time begin) {
  // Whole frames later than the session before, so that the opening does not decide the phase.
  const double share = static_cast<double>(session) / options.sessions;
  const double frames = std::floor(share * kOpeningSeconds * options.frame_rate_hz);
  return begin + Seconds((frames + share) / options.frame_rate_hz);
}

LiveFigures RunLive(const LiveOptions& options, LiveTarget& target) {
  return LiveGenerator(options, target).Run();
}

}  // namespace duet::contrib::load
