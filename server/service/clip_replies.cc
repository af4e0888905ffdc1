#include "server/service/clip_replies.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "model/motion/vec3.h"
#include "server/service/refusals.h"

namespace duet::server::service {
namespace {

v1::MotionGrade ToMessage(const body::Grade& grade) {
  v1::MotionGrade message;
  message.set_twisted(static_cast<float>(grade.twisted));
  message.set_skating(static_cast<float>(grade.skating));
  message.set_leader_skating(static_cast<float>(grade.leader_skating));
  message.set_overlapping(static_cast<float>(grade.overlapping));
  for (const body::FrameRun& run : grade.bad_runs) {
    v1::FrameRun& added = *message.add_bad_runs();
    added.set_first_frame(static_cast<uint32_t>(run.first));
    added.set_frame_count(static_cast<uint32_t>(run.count));
  }
  return message;
}

}  // namespace

absl::Status CheckWindow(const engine::WindowResult& result, int frames, int joints) {
  if (!result.ok()) return result.status();
  const absl::Span<const motion::Vec3> positions = result->all();
  if (result->joint_count() != joints || result->frame_count() != frames ||
      positions.size() % static_cast<std::size_t>(joints) != 0) {
    return absl::InternalError(absl::StrCat(
        "model: expected ", frames, " frames of ", joints, " joints, got ", positions.size(),
        " positions in frames of ", result->joint_count(), " joints"));
  }
  if (!std::all_of(positions.begin(), positions.end(), motion::IsFinite)) {
    return absl::InternalError("model: expected finite positions, got one that is not finite");
  }
  return absl::OkStatus();
}

void ReportCommon(const engine::ModelDescription& model, const engine::SynthesisOptions& options,
                  batching::Priority priority, const metrics::WindowTotals& totals,
                  metrics::CallRecord& record) {
  record.totals = totals;
  record.model = model.name;
  record.version = model.version;
  record.priority = PriorityName(priority);
  record.seed = options.sampling.seed;
  record.variety = options.sampling.variety;
  record.candidates = engine::CandidateCount(model, options.sampling);
  record.clean_up = *options.clean_up;
}

ClipReplies::ClipReplies(ReplyParts parts, ValidatedRequest request)
    : parts_(std::move(parts)),
      options_(request.clip.options),
      priority_(request.priority),
      mapping_(std::move(request.reply)),
      chunk_frames_(request.chunk_frames),
      cancelled_(std::make_shared<std::atomic<bool>>(false)),
      clip_(parts_.model->description(), std::move(request.clip)),
      ready_(0, parts_.model->description().skeleton.joint_count()) {}

absl::Status ClipReplies::Start(SourceEvents events) {
  on_progress_ = std::move(events.on_progress);
  {
    common::MutexLock lock(mutex_);
    in_flight_ = true;
  }
  const absl::Status scheduled = ScheduleNext(/*continues_call=*/false);
  return scheduled.ok() ? scheduled : QueueRefusal(scheduled);
}

NextReply ClipReplies::Next(metrics::CallRecord& record) {
  if (next_ == Part::kEnd) return {nullptr, absl::OkStatus()};
  const bool needs_frames = next_ == Part::kFrames || mapping_.rig.has_value();
  if (needs_frames && next_frames_.empty()) {
    switch (Take()) {
      case Ready::kNothing:
        return {};
      case Ready::kFailed:
        return {nullptr, WindowFailure(error(), record.request_id, &record.cause)};
      case Ready::kAllTaken:
        FillSummary(record);
        next_ = Part::kEnd;
        return {&reply_, {}};
      case Ready::kFrames:
        break;
    }
  }
  if (next_ == Part::kFrames) {
    FillChunk(record);
  } else {
    FillHeader(record);
    next_ = Part::kFrames;
  }
  return {&reply_, {}};
}

ClipReplies::Ready ClipReplies::Take() {
  {
    common::MutexLock lock(mutex_);
    const int count = std::min(ready_.frame_count() - taken_, chunk_frames_);
    if (!error_.ok()) return Ready::kFailed;
    if (count == 0) {
      return in_flight_ || clip_.HasNextWindow() ? Ready::kNothing : Ready::kAllTaken;
    }
    next_frames_ = motion::Poses(0, ready_.joint_count());
    next_frames_.Append(ready_.frames(taken_, count));
    taken_ += count;
  }
  ScheduleIfWanted();
  return Ready::kFrames;
}

absl::Status ClipReplies::error() const {
  common::MutexLock lock(mutex_);
  return error_;
}

ClipReplies::Stats ClipReplies::stats() const {
  common::MutexLock lock(mutex_);
  return stats_;
}

void ClipReplies::FillHeader(const metrics::CallRecord& record) {
  v1::SynthesisHeader& header = *reply_.mutable_header();
  FillCommonHeader(parts_.model->description(), mapping_, options_, record.request_id, header);
  header.set_frame_count(static_cast<uint32_t>(clip_.frame_count()));
  if (mapping_.rig) {
    rig_ = std::make_unique<ReplyRig>(mapping_, next_frames_);
    rig_->FillHeader(header);
  }
  header.set_engine(parts_.engine);
  header.set_server_version(parts_.server_version);
}

void ClipReplies::FillChunk(metrics::CallRecord& record) {
  motion::Poses poses = std::exchange(next_frames_, {});
  v1::MotionChunk& chunk = *reply_.mutable_chunk();
  chunk.Clear();
  if (rig_ != nullptr) rig_->AddRotations(&poses, chunk);
  chunk.set_first_frame(static_cast<uint32_t>(record.frames));
  chunk.set_frame_count(static_cast<uint32_t>(poses.frame_count()));
  AppendPositions(mapping_, poses, chunk.mutable_positions());
  ++record.chunks;
  record.frames += poses.frame_count();
}

void ClipReplies::FillSummary(const metrics::CallRecord& record) {
  const Stats stats = this->stats();
  v1::SynthesisSummary& summary = *reply_.mutable_summary();
  FillCommonSummary(record.frames, stats.totals, summary);
  summary.set_chunk_count(static_cast<uint32_t>(record.chunks));
  if (stats.unfamiliarity) summary.set_unfamiliarity(*stats.unfamiliarity);
  if (stats.grade) *summary.mutable_grade() = ToMessage(*stats.grade);
  summary.mutable_constraint_metres()->Assign(stats.pin_distances.begin(),
                                              stats.pin_distances.end());
}

void ClipReplies::Report(metrics::CallRecord& record) const {
  const Stats stats = this->stats();
  ReportCommon(parts_.model->description(), options_, priority_, stats.totals, record);
  record.unfamiliarity = stats.unfamiliarity;
}

bool ClipReplies::WantsWindow() const {
  if (in_flight_ || !error_.ok() || cancelled_->load(std::memory_order_acquire)) return false;
  const int waiting = ready_.frame_count() - taken_;
  return waiting < parts_.buffered_frames && clip_.HasNextWindow();
}

void ClipReplies::ScheduleIfWanted() {
  {
    common::MutexLock lock(mutex_);
    if (!WantsWindow()) return;
    in_flight_ = true;
  }
  const absl::Status scheduled = ScheduleNext(/*continues_call=*/true);
  if (scheduled.ok()) return;
  common::MutexLock lock(mutex_);
  in_flight_ = false;
  error_ = scheduled;
}

absl::Status ClipReplies::ScheduleNext(bool continues_call) {
  batching::WindowJob job;
  job.model = parts_.model;
  job.window = clip_.NextWindow();
  job.priority = priority_;
  job.deadline = parts_.deadline;
  job.cancelled = cancelled_;
  job.client = parts_.client;
  job.continues_call = continues_call;
  job.call_windows = clip_.window_count();
  job.done = [self = shared_from_this()](const batching::WindowOutcome& outcome) {
    self->OnWindow(outcome);
  };
  expected_frames_ = job.window.leader.frame_count();
  return parts_.scheduler->Submit(std::move(job));
}

void ClipReplies::OnWindow(const batching::WindowOutcome& outcome) {
  if (cancelled_->load(std::memory_order_acquire)) return;
  const int joints = parts_.model->description().skeleton.joint_count();
  const absl::Status status = CheckWindow(outcome.result, expected_frames_, joints);
  motion::Poses frames;
  if (status.ok()) {
    frames = clip_.Accept(*outcome.result);
    KeepMeasures();
  }
  Keep(status, frames, outcome.timings);
  ScheduleIfWanted();
  on_progress_();
}

void ClipReplies::KeepMeasures() {
  if (clip_.HasNextWindow()) return;
  const std::optional<double> unfamiliarity = parts_.model->Unfamiliarity(clip_.request());
  std::optional<body::Grade> grade = clip_.grade();
  common::MutexLock lock(mutex_);
  stats_.unfamiliarity = unfamiliarity;
  stats_.grade = std::move(grade);
  stats_.pin_distances = clip_.pin_distances();
}

void ClipReplies::Keep(const absl::Status& status, const motion::Poses& frames,
                       const batching::WindowTimings& timings) {
  common::MutexLock lock(mutex_);
  in_flight_ = false;
  error_ = status;
  metrics::WindowTotals& totals = stats_.totals;
  totals.windows += status.ok() ? 1 : 0;
  totals.queue_seconds += timings.queue_seconds;
  totals.compute_seconds += timings.compute_seconds;
  ready_.DropFront(taken_);
  taken_ = 0;
  ready_.Append(frames.all());
  totals.peak_buffered_frames = std::max(totals.peak_buffered_frames, ready_.frame_count());
}

}  // namespace duet::server::service
