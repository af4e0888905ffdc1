#ifndef DUET_SERVER_SERVICE_LIVE_REPLIES_H_
#define DUET_SERVER_SERVICE_LIVE_REPLIES_H_

#include <google/protobuf/repeated_field.h>

#include <atomic>
#include <deque>
#include <memory>
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
#include "server/service/clip_replies.h"
#include "server/service/reply_mapping.h"
#include "server/service/reply_source.h"
#include "server/service/validator.h"

namespace duet::server::service {

// The replies of SynthesizeLive: header, then frames and notices, then summary.
//
// Takes leader frames and label changes as they arrive, runs one window at a time through the
// scheduler, and keeps the final frames until they are taken. Reads the next message only while the
// caller takes its frames, so memory is bounded.
//
// No window of a session is refused because the queue is full: the session has its place among the
// calls, and at most one window in the queue. The first window waits for at most ten seconds, then
// the session ends. Model failures become INTERNAL without details; CallRecord::cause has the
// details for the log.
//
// Threads: safe to call concurrently. on_progress runs under no lock. Uses neither gRPC nor
//          abseil's synchronisation (ARCHITECTURE.md).
class LiveReplies final : public ReplySource, public std::enable_shared_from_this<LiveReplies> {
 public:
  // Requires start.live.options.clean_up to be set.
  LiveReplies(ReplyParts parts, ValidatedLiveStart start);

  // Answers the frames of the history, and begins to read messages.
  absl::Status Start(SourceEvents events) override;
  NextReply Next(metrics::CallRecord& record) override;
  void Cancel() override { cancelled_->store(true, std::memory_order_release); }
  void Report(metrics::CallRecord& record) const override;
  void OnMessage(const absl::StatusOr<v1::SynthesizeLiveRequest>& message) override;
  void OnEndOfMessages() override;
  // Notifies the caller, also one that sends nothing.
  void OnDraining() override;

 private:
  // Frames of a session that were not as announced.
  struct Irregular {
    int gap = 0;
    int late = 0;
    int skipped = 0;
  };

  void FillHeader(const metrics::CallRecord& record) DUET_REQUIRES(mutex_);
  void FillFrames(metrics::CallRecord& record) DUET_REQUIRES(mutex_);
  void FillSummary(const metrics::CallRecord& record) DUET_REQUIRES(mutex_);

  absl::Status Handle(const v1::SynthesizeLiveRequest& message) DUET_EXCLUDES(mutex_);
  // The first error counts.
  void Fail(const absl::Status& error) DUET_REQUIRES(mutex_);
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
  int next_leader_frame() const DUET_EXCLUDES(mutex_);

  const ReplyParts parts_;
  const ReplyMapping format_;  // of both motions
  const engine::SynthesisOptions options_;
  const int plan_frames_;
  const bool rotations_;
  const double frame_rate_hz_;
  const int first_frame_, history_frames_;
  const std::shared_ptr<std::atomic<bool>> cancelled_;
  SourceEvents events_;  // constant after Start

  // Used only by the thread that asks for replies.
  bool sent_header_ = false, sent_summary_ = false;
  v1::SynthesizeLiveResponse reply_;  // the last one returned

  mutable common::Mutex mutex_;
  // With rotations: frame 0 of the leader, and the rig from the first answer on.
  motion::Poses rig_leader_ DUET_GUARDED_BY(mutex_);
  std::unique_ptr<LiveRig> rig_ DUET_GUARDED_BY(mutex_);
  engine::LiveSynthesis live_ DUET_GUARDED_BY(mutex_);
  std::deque<int> announced_ DUET_GUARDED_BY(mutex_);  // frames of changes to come, ascending
  bool in_flight_ DUET_GUARDED_BY(mutex_) = false;
  int window_frames_ DUET_GUARDED_BY(mutex_) = 0;  // of the window in flight
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
  bool window_failed_ DUET_GUARDED_BY(mutex_) = false;  // the reason for error_
  metrics::WindowTotals totals_ DUET_GUARDED_BY(mutex_);
  Irregular irregular_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_LIVE_REPLIES_H_
