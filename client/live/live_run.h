#ifndef DUET_CLIENT_LIVE_LIVE_RUN_H_
#define DUET_CLIENT_LIVE_LIVE_RUN_H_

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/client.h"
#include "client/live/follower_sink.h"
#include "client/live/latency.h"
#include "client/live/leader_source.h"
#include "client/live_session.h"

namespace duet::client::live {

// The figures of a run so far.
struct LiveProgress {
  absl::Duration time;  // since the session began
  int frames = 0;       // final frames
  // From the capture of the last leader frame that a follower frame waits for to its arrival:
  // without the delay, which the caller chose.
  Latencies latency;
  int gap_frames = 0, late_frames = 0, skipped_frames = 0;
  int resumed = 0;
};

// A finished run. `latency` is that of the whole run.
struct LiveReport {
  LiveInfo info;
  LiveProgress totals;
  int leader_frames = 0;
  double frame_rate_hz = 0;
  std::vector<std::string> written;  // by the sinks
  std::vector<std::string> notes;    // of the source
};

// Functions that a run calls, one at a time.
struct LiveObserver {
  // After each answer, with the latency of the last kLatencySpan.
  std::function<void(const LiveProgress&)> on_progress;
  std::function<void(const LiveNotice&)> on_notice;
};
inline constexpr absl::Duration kLatencySpan = absl::Seconds(5);

// Runs a session from a source to sinks.
class LiveRun {
 public:
  // The source and the sinks outlive the run.
  LiveRun(LeaderSource* source, std::vector<FollowerSink*> sinks, LiveObserver observer)
      : source_(source), sinks_(std::move(sinks)), observer_(std::move(observer)) {}

  // Blocks until the leader has ended, or the source was stopped, and every frame that is due has
  // been answered. `request` lacks joints and frame rate. Writes what there is even if the session
  // fails.
  //
  // Errors: those of the source, the session and the sinks; the first of them.
  absl::StatusOr<LiveReport> Run(const Client& client, LiveRequest request);

  // Changes the labels from the next frame on. May be called by any thread, while Run runs. Errors:
  // FAILED_PRECONDITION if the session has not begun or is over; those of LiveSession.
  absl::Status ChangeLabels(const LabelCommand& labels);

 private:
  absl::Status RunSession(const Client& client, const LiveRequest& request);
  absl::Status Follow(LiveSession* session);
  absl::Status Send(LiveSession* session, const LeaderFrame& frame);
  void WaitForAnswers();
  void End();
  void SetSession(LiveSession* session);
  absl::Status Accept(const LiveFrames& frames);
  void Count(const LiveNotice& notice);
  LiveProgress Progress(absl::Time since) const;
  absl::Status FinishSinks();

  LeaderSource* const source_;
  const std::vector<FollowerSink*> sinks_;
  const LiveObserver observer_;
  int delay_frames_ = 0;
  LiveReport report_;

  std::mutex mutex_;  // of everything below, and of the sinks
  std::condition_variable answered_;
  LiveSession* session_ = nullptr;  // while frames are sent
  absl::Time begin_;
  LatencyLog latencies_;
  std::deque<absl::Time> captured_;  // of the leader frames from first_captured_ on
  int first_captured_ = 0;
  int sent_end_ = 0, answered_end_ = 0;
  bool ended_ = false;  // the session has ended
};

}  // namespace duet::client::live

#endif  // DUET_CLIENT_LIVE_LIVE_RUN_H_
