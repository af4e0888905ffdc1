#include "server/service/live_replies.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/service/refusals.h"

namespace duet::server::service {
namespace {

constexpr double kMaxGapSeconds = 2;
// While more leader frames than this many seconds wait for an answer, none are read.
constexpr double kMaxUnansweredSeconds = 2;
constexpr std::size_t kMaxWaitingNotices = 16;
// A session that gets no answer for so long is not live, and the caller can try another server.
constexpr double kMaxFirstWaitSeconds = 10;

int HistoryFrames(const engine::ModelDescription& model, const ValidatedLiveStart& start) {
  const double rate = start.live.frame_rate_hz;
  const int frames = engine::LiveTiming(model, rate, start.live.delay_frames).history_frames();
  return start.rotations ? std::max(frames, LiveRig::HistoryFrames(rate)) : frames;
}

// The rig of a resumed session, fitted up to its last frame; null for a new one.
std::unique_ptr<LiveRig> ResumedRig(const motion::Skeleton& skeleton,
                                    const ValidatedLiveStart& start) {
  if (start.rig_follower.empty()) return nullptr;
  auto rig = std::make_unique<LiveRig>(skeleton, start.reply, start.rig_leader, start.rig_follower);
  // A caller may send more history than the fit depends on.
  motion::Poses history = start.live.follower;
  const int unread =
      std::max(0, history.frame_count() - LiveRig::HistoryFrames(start.live.frame_rate_hz));
  history.DropFront(unread);
  google::protobuf::RepeatedField<float> answered;
  rig->Fit(start.live.first_frame + unread, history, &answered);
  return rig;
}

absl::Status MalformedMessage(absl::string_view got) {
  return Malformed("payload", "frames or label_change", got);
}

}  // namespace

LiveReplies::LiveReplies(ReplyParts parts, ValidatedLiveStart start)
    : parts_(std::move(parts)),
      format_(start.reply),
      options_(start.live.options),
      plan_frames_(start.plan_frames),
      rotations_(start.rotations),
      frame_rate_hz_(start.live.frame_rate_hz),
      first_frame_(start.live.first_frame + start.live.follower.frame_count()),
      history_frames_(HistoryFrames(parts_.model->description(), start)),
      cancelled_(std::make_shared<std::atomic<bool>>(false)),
      rig_leader_(start.rig_leader),
      rig_(ResumedRig(parts_.model->description().skeleton, start)),
      live_(parts_.model->description(), std::move(start.live)),
      arrival_(parts_.clock->Now()) {}

absl::Status LiveReplies::Start(SourceEvents events) {
  events_ = std::move(events);
  Work();
  return absl::OkStatus();
}

NextReply LiveReplies::Next(metrics::CallRecord& record) {
  if (sent_summary_) return {nullptr, absl::OkStatus()};
  {
    common::MutexLock lock(mutex_);
    if (!sent_header_) {
      FillHeader(record);
    } else if (!notices_.empty()) {
      *reply_.mutable_notice() = std::move(notices_.front());
      notices_.erase(notices_.begin());
    } else if (!ready_.empty()) {
      FillFrames(record);
    } else if (!error_.ok()) {
      return {nullptr,
              window_failed_ ? WindowFailure(error_, record.request_id, &record.cause) : error_};
    } else if (ended_ && !in_flight_ && live_.done()) {
      FillSummary(record);
    } else {
      return {};
    }
  }
  ReadOn();
  return {&reply_, {}};
}

void LiveReplies::FillHeader(const metrics::CallRecord& record) {
  sent_header_ = true;
  v1::LiveHeader& header = *reply_.mutable_header();
  FillCommonHeader(parts_.model->description(), format_, options_, record.request_id, header);
  header.set_delay_frames(static_cast<uint32_t>(live_.delay_frames()));
  header.set_first_frame(static_cast<uint32_t>(first_frame_));
  header.set_history_frames(static_cast<uint32_t>(history_frames_));
}

void LiveReplies::FillFrames(metrics::CallRecord& record) {
  const int count = waiting_frames();
  v1::FollowerFrames& frames = *reply_.mutable_frames();
  frames.Clear();
  frames.set_first_frame(static_cast<uint32_t>(live_.next_follower_frame() - count));
  frames.set_frame_count(static_cast<uint32_t>(count));
  frames.mutable_positions()->Swap(&ready_);
  frames.mutable_rotations()->Swap(&ready_rotations_);
  if (rig_ != nullptr && !sent_rig_) rig_->AppendRig(frames.mutable_rig());
  sent_rig_ = true;
  if (plan_frames_ > 0) {
    AppendPositions(format_, live_.Plan(plan_frames_).poses, frames.mutable_plan_positions());
  }
  frames.set_leader_frame(static_cast<uint32_t>(live_.next_leader_frame() - 1));
  frames.set_capture_seconds(capture_seconds_);
  const double seconds = common::SecondsBetween(arrival_, parts_.clock->Now());
  frames.set_server_seconds(static_cast<float>(seconds));
  // A session begins long before its first leader frame.
  if (record.chunks == 0) record.first_chunk_seconds = seconds;
  ++record.chunks;
  record.frames += count;
}

void LiveReplies::FillSummary(const metrics::CallRecord& record) {
  sent_summary_ = true;
  v1::LiveSummary& summary = *reply_.mutable_summary();
  FillCommonSummary(record.frames, totals_, summary);
  summary.set_gap_frames(static_cast<uint32_t>(irregular_.gap));
  summary.set_late_frames(static_cast<uint32_t>(irregular_.late));
  summary.set_skipped_frames(static_cast<uint32_t>(irregular_.skipped));
}

void LiveReplies::Report(metrics::CallRecord& record) const {
  common::MutexLock lock(mutex_);
  ReportCommon(parts_.model->description(), options_, batching::Priority::kInteractive, totals_,
               record);
}

void LiveReplies::OnMessage(const absl::StatusOr<v1::SynthesizeLiveRequest>& message) {
  const absl::Status status = message.ok() ? Handle(*message) : message.status();
  {
    common::MutexLock lock(mutex_);
    reading_ = false;
    Fail(status);
  }
  Work();
  events_.on_progress();
}

void LiveReplies::OnEndOfMessages() {
  {
    common::MutexLock lock(mutex_);
    reading_ = false;
    ended_ = true;
    live_.EndLeader();
  }
  Work();
  events_.on_progress();
}

void LiveReplies::OnDraining() {
  {
    common::MutexLock lock(mutex_);
    Notify(v1::LIVE_NOTICE_KIND_DRAINING, 0, 0);
  }
  events_.on_progress();
}

void LiveReplies::Fail(const absl::Status& error) {
  if (error_.ok()) error_ = error;
}

absl::Status LiveReplies::Handle(const v1::SynthesizeLiveRequest& message) {
  switch (message.payload_case()) {
    case v1::SynthesizeLiveRequest::kFrames:
      return AddFrames(message.frames());
    case v1::SynthesizeLiveRequest::kLabelChange:
      return ChangeLabels(message.label_change());
    case v1::SynthesizeLiveRequest::kStart:
      return MalformedMessage("a second start");
    case v1::SynthesizeLiveRequest::PAYLOAD_NOT_SET:
      break;
  }
  return MalformedMessage("none");
}

absl::Status LiveReplies::AddFrames(const v1::LeaderFrames& frames) {
  // Messages are handled one at a time, and nothing else adds leader frames.
  const int newest = next_leader_frame();
  absl::StatusOr<motion::Poses> poses =
      ReadLeaderFrames(frames, format_, parts_.model->description(), parts_.limits,
                       /*check_size=*/newest == 0);
  if (!poses.ok()) return poses.status();
  common::MutexLock lock(mutex_);
  absl::Status added = AddPoses(static_cast<int>(frames.first_frame()), *std::move(poses));
  if (live_.next_leader_frame() > newest) {
    arrival_ = parts_.clock->Now();
    capture_seconds_ = frames.capture_seconds();
  }
  return added;
}

absl::Status LiveReplies::AddPoses(int first, motion::Poses poses) {
  const int next = live_.next_leader_frame(), end = first + poses.frame_count();
  const int late = std::min(next, end) - first, gap = first - next;
  const int most_missing = static_cast<int>(kMaxGapSeconds * frame_rate_hz_);
  if (end > kMaxLiveFrames || gap > most_missing) {
    return Malformed("frames.first_frame",
                     absl::StrCat("at most ", next + most_missing, " (", kMaxGapSeconds,
                                  " s after frame ", next, ", the next one)"),
                     absl::StrCat(first, "; after a longer gap, resume with LiveStart.history"));
  }
  if (late > 0) {
    irregular_.late += late;
    Notify(v1::LIVE_NOTICE_KIND_LATE, first, late);
    poses.DropFront(late);
  }
  if (gap > 0) {
    irregular_.gap += gap;
    Notify(v1::LIVE_NOTICE_KIND_GAP_FILLED, next, gap);
    FillGap(gap, poses);
  }
  if (rotations_ && next == 0)
    rig_leader_ = motion::Poses(poses.joint_count(), {poses[0].begin(), poses[0].end()});
  live_.AddLeader(poses);
  return absl::OkStatus();
}

void LiveReplies::FillGap(int count, const motion::Poses& next) {
  const int joints = next.joint_count();
  // Before the first frame there is nothing to interpolate from.
  const absl::Span<const motion::Vec3> after = next[0];
  const absl::Span<const motion::Vec3> before =
      live_.newest_leader().empty() ? after : live_.newest_leader();
  motion::Poses gap(count, joints);
  for (int t = 0; t < count; ++t) {
    const float at = static_cast<float>(t + 1) / static_cast<float>(count + 1);
    for (int j = 0; j < joints; ++j) {
      const auto joint = static_cast<std::size_t>(j);
      gap.at(t, j) = Lerp(before[joint], after[joint], at);
    }
  }
  live_.AddLeader(gap);
}

absl::Status LiveReplies::ChangeLabels(const v1::LabelChange& change) {
  common::MutexLock lock(mutex_);
  const int next = std::max(0, live_.next_leader_frame() - live_.delay_frames());
  const absl::StatusOr<ValidatedLabelChange> valid =
      ReadLabelChange(change, next, frame_rate_hz_, parts_.model->description(), parts_.limits);
  if (!valid.ok()) return valid.status();
  absl::Status announced = Announce(valid->frame, next);
  if (!announced.ok()) return announced;
  live_.ChangeLabels(valid->frame, valid->ease_frames, valid->weights);
  return absl::OkStatus();
}

absl::Status LiveReplies::Announce(int frame, int next) {
  // As LabelTrack: later changes are dropped, earlier ones apply by now.
  while (!announced_.empty() && announced_.back() >= frame) announced_.pop_back();
  while (!announced_.empty() && announced_.front() <= next) announced_.pop_front();
  if (announced_.size() >= static_cast<std::size_t>(parts_.limits.max_label_keyframes)) {
    return Malformed("label_change.frame",
                     absl::StrCat("at most ", parts_.limits.max_label_keyframes,
                                  " changes of frames that are not final"),
                     absl::StrCat(announced_.size() + 1));
  }
  announced_.push_back(frame);
  return absl::OkStatus();
}

void LiveReplies::Notify(v1::LiveNoticeKind kind, int first, int count) {
  v1::LiveNotice notice;
  notice.set_kind(kind);
  if (count > 0) {
    notice.mutable_frames()->set_first_frame(static_cast<uint32_t>(first));
    notice.mutable_frames()->set_frame_count(static_cast<uint32_t>(count));
  }
  notices_.push_back(std::move(notice));
}

void LiveReplies::Work() {
  std::optional<batching::WindowJob> job;
  {
    common::MutexLock lock(mutex_);
    if (!in_flight_ && error_.ok() && !cancelled_->load(std::memory_order_acquire)) {
      KeepDueFrames();
      if (live_.NeedsWindow()) job = NextJob();
    }
  }
  if (job) Schedule(*std::move(job));
  ReadOn();
}

void LiveReplies::KeepDueFrames() {
  for (;;) {
    engine::LiveFrames due = live_.TakeDue();
    if (due.poses.frame_count() == 0) return;
    live_.Settle(KeepFrames(std::move(due)));
    totals_.peak_buffered_frames = std::max(totals_.peak_buffered_frames, waiting_frames());
  }
}

motion::Poses LiveReplies::KeepFrames(engine::LiveFrames due) {
  if (rotations_ && rig_ == nullptr) MakeRig(due.poses);
  if (rig_ != nullptr) rig_->KeepBoneLengths(due.first, &due.poses);
  google::protobuf::RepeatedField<float> sent;
  AppendPositions(format_, due.poses, &sent);
  motion::Poses frames = FromPositions(format_, sent);
  if (rig_ != nullptr) rig_->Fit(due.first, frames, &ready_rotations_);
  ready_.Add(sent.begin(), sent.end());
  return frames;
}

void LiveReplies::MakeRig(const motion::Poses& follower) {
  google::protobuf::RepeatedField<float> sent;
  AppendPositions(format_,
                  motion::Poses(follower.joint_count(), {follower[0].begin(), follower[0].end()}),
                  &sent);
  rig_ = std::make_unique<LiveRig>(parts_.model->description().skeleton, format_, rig_leader_,
                                   FromPositions(format_, sent));
}

batching::WindowJob LiveReplies::NextJob() {
  in_flight_ = true;
  batching::WindowJob job;
  job.model = parts_.model;
  job.window = live_.NextWindow();
  job.priority = batching::Priority::kInteractive;
  job.deadline = WindowDeadline();
  job.due = arrival_ + common::Seconds(1 / frame_rate_hz_);
  job.cancelled = cancelled_;
  job.continues_call = true;  // also the first: the session was admitted
  job.client = parts_.client;
  job.done = [self = shared_from_this()](const batching::WindowOutcome& outcome) {
    self->OnWindow(outcome);
  };
  window_frames_ = job.window.leader.frame_count();
  return job;
}

common::TimePoint LiveReplies::WindowDeadline() const {
  if (totals_.windows > 0) return parts_.deadline;
  return std::min(parts_.deadline, parts_.clock->Now() + common::Seconds(kMaxFirstWaitSeconds));
}

void LiveReplies::Schedule(batching::WindowJob job) {
  const absl::Status scheduled = parts_.scheduler->Submit(std::move(job));
  if (scheduled.ok()) return;
  common::MutexLock lock(mutex_);
  in_flight_ = false;
  Fail(QueueRefusal(scheduled));
}

void LiveReplies::OnWindow(const batching::WindowOutcome& outcome) {
  if (cancelled_->load(std::memory_order_acquire)) return;
  {
    common::MutexLock lock(mutex_);
    in_flight_ = false;
    Accept(outcome);
  }
  Work();
  events_.on_progress();
}

void LiveReplies::Accept(const batching::WindowOutcome& outcome) {
  totals_.queue_seconds += outcome.timings.queue_seconds;
  totals_.compute_seconds += outcome.timings.compute_seconds;
  const absl::Status status = CheckWindow(outcome.result, window_frames_,
                                          parts_.model->description().skeleton.joint_count());
  const bool waited_in_vain = totals_.windows == 0 && absl::IsDeadlineExceeded(status) &&
                              parts_.clock->Now() < parts_.deadline;
  if (waited_in_vain) {
    return Fail(QueueRefusal(absl::ResourceExhaustedError(
        absl::StrCat("the queue is too long: the first answer of the session was not started "
                     "within ",
                     kMaxFirstWaitSeconds, " s"))));
  }
  if (!status.ok()) {
    window_failed_ = error_.ok();
    return Fail(status);
  }
  ++totals_.windows;
  live_.Accept(*outcome.result);
  const int skipped = live_.skipped_frames() - irregular_.skipped;
  if (skipped > 0) {
    Notify(v1::LIVE_NOTICE_KIND_SKIPPED, live_.next_follower_frame() - skipped, skipped);
    irregular_.skipped += skipped;
  }
}

bool LiveReplies::WantsMessage() const {
  const int unanswered = live_.next_leader_frame() - live_.next_follower_frame();
  return !reading_ && !ended_ && error_.ok() && waiting_frames() < parts_.buffered_frames &&
         notices_.size() < kMaxWaitingNotices &&
         unanswered <= kMaxUnansweredSeconds * frame_rate_hz_ + live_.delay_frames();
}

void LiveReplies::ReadOn() {
  {
    common::MutexLock lock(mutex_);
    if (!WantsMessage()) return;
    reading_ = true;
  }
  // False if the call has ended: then no message is wanted any more.
  events_.read_next(parts_.idle_seconds);
}

int LiveReplies::next_leader_frame() const {
  common::MutexLock lock(mutex_);
  return live_.next_leader_frame();
}

int LiveReplies::waiting_frames() const {
  return ready_.size() / (3 * static_cast<int>(format_.joints.size()));
}

}  // namespace duet::server::service
