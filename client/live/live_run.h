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
#include "client/live/ends.h"
#include "client/live_session.h"

namespace duet::client::live {

// Two percentiles of latencies.
struct Latencies {
  absl::Duration p50, p99;
};

// The latencies of the last frames, at most kKept of them.
class LatencyLog {
 public:
  static constexpr std::size_t kKept = std::size_t{1} << 18;

  void Add(absl::Duration latency);
  // Zero without frames.
  Latencies Percentiles() const;

 private:
  std::vector<absl::Duration> kept_;  // a ring, once it is full
  std::size_t next_ = 0;
};

// A finished run.
struct LiveReport {
  LiveInfo info;
  LiveSummary summary;
  absl::Duration time;  // since the session began
  // From the capture of the last leader frame that a follower frame waits for to its arrival:
  // without the delay, which the caller chose.
  Latencies latency;
  double frame_rate_hz = 0;
  std::vector<std::string> written;  // by the sinks
  std::vector<std::string> notes;    // of the source
};

// Runs a session from a source to sinks.
class LiveRun {
 public:
  // The source and the sinks outlive the run. `on_notice`, which may be empty, is called by one
  // thread at a time.
  LiveRun(LeaderSource* source, std::vector<FollowerSink*> sinks,
          std::function<void(const LiveNotice&)> on_notice)
      : source_(source), sinks_(std::move(sinks)), on_notice_(std::move(on_notice)) {}

  // Blocks until the leader has ended, or the source was stopped, and every frame that is due has
  // been answered. `request` lacks joints and frame rate. Writes what there is even if the session
  // fails.
  //
  // Errors: those of the source, the session and the sinks; the first of them.
  absl::StatusOr<LiveReport> Run(const Client& client, LiveRequest request);

 private:
  absl::Status RunSession(const Client& client, const LiveRequest& request);
  absl::Status Follow(LiveSession* session);
  absl::Status Send(LiveSession* session, const LeaderFrame& frame);
  void WaitForAnswers();
  void End();
  absl::Status Accept(const LiveFrames& frames);
  absl::Status FinishSinks();

  LeaderSource* const source_;
  const std::vector<FollowerSink*> sinks_;
  const std::function<void(const LiveNotice&)> on_notice_;
  int delay_frames_ = 0;
  LiveReport report_;

  std::mutex mutex_;  // of everything below, and of the sinks
  std::condition_variable answered_;
  absl::Time begin_;
  LatencyLog latencies_;
  std::deque<absl::Time> captured_;  // of the leader frames from first_captured_ on
  int first_captured_ = 0;
  int sent_end_ = 0, answered_end_ = 0;
  bool ended_ = false;  // the session has ended
};

}  // namespace duet::client::live

#endif  // DUET_CLIENT_LIVE_LIVE_RUN_H_
