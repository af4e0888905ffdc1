#ifndef DUET_SERVER_SERVICE_LIVE_SESSION_H_
#define DUET_SERVER_SERVICE_LIVE_SESSION_H_

#include <google/protobuf/repeated_field.h>

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "duet/v1/live.pb.h"
#include "model/engine/live_synthesis.h"
#include "model/engine/synthesizer.h"
#include "server/batching/window_scheduler.h"
#include "server/common/clock.h"
#include "server/common/mutex.h"
#include "server/service/reply_mapping.h"
#include "server/service/request_limits.h"
#include "server/service/validate_live.h"

namespace duet::server::service {

// What a live session depends on. Pointers outlive the session and its windows.
struct LiveSessionParts {
  std::shared_ptr<const engine::Synthesizer> model;
  batching::WindowScheduler* scheduler = nullptr;
  const common::Clock* clock = nullptr;
  RequestLimits limits;
  common::TimePoint deadline = common::TimePoint::max();
  std::string client;       // see WindowJob
  double idle_seconds = 0;  // the longest time between two messages
  int buffered_frames = 0;  // no message is read while more frames wait for the reader
};

// Totals of a session.
struct LiveStats {
  int windows = 0;
  double queue_seconds = 0;
  double compute_seconds = 0;
  int gap_frames = 0;
  int late_frames = 0;
  int skipped_frames = 0;
  int peak_buffered_frames = 0;
};

// Where the error of a session comes from.
enum class LiveFault {
  kMessage,  // the caller's message
  kQueue,    // the scheduler did not take a window, or did not start the first one in time
  kWindow    // a window failed
};

// What a session has for its caller now: at most one of the fields.
struct LiveOutput {
  std::optional<v1::LiveNotice> notice;
  std::optional<v1::FollowerFrames> frames;  // without the time at the server
  // When the newest leader frame of `frames` arrived.
  common::TimePoint arrival;
  bool end = false;                       // every frame was taken
  absl::Status error;                     // the session ends with this
  LiveFault fault = LiveFault::kMessage;  // of `error`
};

// A live session: takes leader frames and label changes as they arrive, runs one window at a time
// through the scheduler, and keeps the final frames until they are taken. Reads the next message
// only while the caller takes its frames, so memory is bounded.
//
// No window of a session is refused because the queue is full: the session has its place among the
// calls, and at most one window in the queue. The first window waits for at most ten seconds, then
// the session ends.
//
// Threads: safe to call concurrently. on_progress runs under no lock, and may still run after the
//          end was taken. Uses neither gRPC nor abseil's synchronisation (ARCHITECTURE.md).
class LiveSession final : public std::enable_shared_from_this<LiveSession> {
 public:
  LiveSession(LiveSessionParts parts, ValidatedLiveStart start);

  // Answers the frames of the history. Call once, before everything else.
  void Start(std::function<void()> on_progress);
  // Begins to read messages. `read_next` reads one, within so many seconds, and returns false if
  // there will be none (Call::ReadNext).
  void Read(std::function<bool(double)> read_next);

  // The message that was read, or why it is not one.
  void OnMessage(const absl::StatusOr<v1::SynthesizeLiveRequest>& message);
  void OnEndOfMessages();
  // Notifies the caller that the server drains, also one that sends nothing. Call once.
  void OnDraining();

  LiveOutput Take();
  void Cancel();

  int first_frame() const { return first_frame_; }
  int history_frames() const { return history_frames_; }
  LiveStats stats() const;

 private:
  absl::Status Handle(const v1::SynthesizeLiveRequest& message) DUET_EXCLUDES(mutex_);
  // The first error counts.
  void Fail(const absl::Status& error, LiveFault fault) DUET_REQUIRES(mutex_);
  absl::Status AddFrames(const v1::LeaderFrames& frames) DUET_EXCLUDES(mutex_);
  absl::Status AddPoses(int first, motion::Poses poses) DUET_REQUIRES(mutex_);
  absl::Status ChangeLabels(const v1::LabelChange& change) DUET_EXCLUDES(mutex_);
  // Counts a change of labels from `frame` on, so that a caller cannot announce any number of them.
  absl::Status Announce(int frame, int next) DUET_REQUIRES(mutex_);
  // Interpolates the `count` leader frames before `next`.
  void FillGap(int count, const motion::Poses& next) DUET_REQUIRES(mutex_);
  void Notify(v1::LiveNoticeKind kind, int first, int count) DUET_REQUIRES(mutex_);

  // Hands out what is due, schedules a window if one is needed, and reads on.
  void Work() DUET_EXCLUDES(mutex_);
  void KeepDueFrames() DUET_REQUIRES(mutex_);
  // Keeps frames, and returns them as the caller gets them.
  motion::Poses KeepFrames(engine::LiveFrames due) DUET_REQUIRES(mutex_);
  void MakeRig(const motion::Poses& follower) DUET_REQUIRES(mutex_);
  batching::WindowJob NextJob() DUET_REQUIRES(mutex_);
  common::TimePoint WindowDeadline() const DUET_REQUIRES(mutex_);
  void Schedule(batching::WindowJob job) DUET_EXCLUDES(mutex_);
  void OnWindow(const batching::WindowOutcome& outcome) DUET_EXCLUDES(mutex_);
  void Accept(const batching::WindowOutcome& outcome) DUET_REQUIRES(mutex_);
  void ReadOn() DUET_EXCLUDES(mutex_);
  bool WantsMessage() const DUET_REQUIRES(mutex_);
  int waiting_frames() const DUET_REQUIRES(mutex_);
  void FillFrames(v1::FollowerFrames* frames) DUET_REQUIRES(mutex_);

  const LiveSessionParts parts_;
  const ReplyMapping format_;  // of both motions
  const int plan_frames_;
  const bool rotations_;
  const double frame_rate_hz_;
  const int first_frame_, history_frames_;
  const std::shared_ptr<std::atomic<bool>> cancelled_;
  std::function<void()> on_progress_;  // constant after Start

  mutable common::Mutex mutex_;
  // With rotations: frame 0 of the leader, and the rig from the first answer on.
  motion::Poses rig_leader_ DUET_GUARDED_BY(mutex_);
  std::unique_ptr<LiveRig> rig_ DUET_GUARDED_BY(mutex_);
  engine::LiveSynthesis live_ DUET_GUARDED_BY(mutex_);
  std::deque<int> announced_ DUET_GUARDED_BY(mutex_);  // frames of changes to come, ascending
  bool in_flight_ DUET_GUARDED_BY(mutex_) = false;
  int window_frames_ DUET_GUARDED_BY(mutex_) = 0;  // of the window in flight
  std::function<bool(double)> read_next_ DUET_GUARDED_BY(mutex_);
  bool reading_ DUET_GUARDED_BY(mutex_) = false;
  bool ended_ DUET_GUARDED_BY(mutex_) = false;         // the caller sends no more messages
  common::TimePoint arrival_ DUET_GUARDED_BY(mutex_);  // of the newest leader frame
  double capture_seconds_ DUET_GUARDED_BY(mutex_) = 0;
  // Final frames that wait for the reader, as they are sent: [frames, joints, 3].
  google::protobuf::RepeatedField<float> ready_ DUET_GUARDED_BY(mutex_);
  google::protobuf::RepeatedField<float> ready_rotations_ DUET_GUARDED_BY(mutex_);
  bool sent_rig_ DUET_GUARDED_BY(mutex_) = false;
  std::vector<v1::LiveNotice> notices_ DUET_GUARDED_BY(mutex_);
  absl::Status error_ DUET_GUARDED_BY(mutex_);
  LiveFault fault_ DUET_GUARDED_BY(mutex_) = LiveFault::kMessage;  // of error_
  LiveStats stats_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_LIVE_SESSION_H_
