#include "server/service/clip_stream.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "absl/types/span.h"
#include "model/motion/vec3.h"

namespace duet::server::service {

absl::Status CheckWindow(const engine::WindowResult& result, int frames, int joints) {
  if (!result.ok()) return result.status();
  const absl::Span<const motion::Vec3> positions = result->all();
  if (result->joint_count() != joints || result->frame_count() != frames ||
      positions.size() % static_cast<std::size_t>(joints) != 0) {
    return absl::InternalError("model: expected " + std::to_string(frames) + " frames of " +
                               std::to_string(joints) + " joints, got " +
                               std::to_string(positions.size()) + " positions in frames of " +
                               std::to_string(result->joint_count()) + " joints");
  }
  if (!std::all_of(positions.begin(), positions.end(), motion::IsFinite)) {
    return absl::InternalError("model: expected finite positions, got one that is not finite");
  }
  return absl::OkStatus();
}

ClipStream::ClipStream(std::shared_ptr<const engine::Synthesizer> model,
                       engine::ClipRequest request, const ClipStreamOptions& options,
                       batching::WindowScheduler& scheduler, std::function<void()> on_progress)
    : model_(std::move(model)),
      options_(options),
      scheduler_(scheduler),
      on_progress_(std::move(on_progress)),
      cancelled_(std::make_shared<std::atomic<bool>>(false)),
      clip_(model_->description(), std::move(request)),
      ready_(0, model_->description().skeleton.joint_count()) {}

absl::Status ClipStream::Start() {
  {
    common::MutexLock lock(mutex_);
    in_flight_ = true;
  }
  return ScheduleNext(/*continues_call=*/false);
}

ClipPart ClipStream::Take(int max_frames) {
  ClipPart part;
  {
    common::MutexLock lock(mutex_);
    const int available = ready_.frame_count() - taken_;
    if (!error_.ok()) {
      part.kind = ClipPart::Kind::kFailed;
      part.error = error_;
    } else if (available > 0) {
      const int count = std::min(available, max_frames);
      part.kind = ClipPart::Kind::kFrames;
      part.poses = motion::Poses(0, ready_.joint_count());
      part.poses.Append(ready_.frames(taken_, count));
      taken_ += count;
    } else if (!in_flight_ && !clip_.HasNextWindow()) {
      part.kind = ClipPart::Kind::kEnd;
    }
  }
  if (part.kind == ClipPart::Kind::kFrames) ScheduleIfWanted();
  return part;
}

void ClipStream::Cancel() { cancelled_->store(true, std::memory_order_release); }

ClipStreamStats ClipStream::stats() const {
  common::MutexLock lock(mutex_);
  return stats_;
}

bool ClipStream::WantsWindow() const {
  if (in_flight_ || !error_.ok() || cancelled_->load(std::memory_order_acquire)) return false;
  const int waiting = ready_.frame_count() - taken_;
  return waiting < options_.buffered_frames && clip_.HasNextWindow();
}

void ClipStream::ScheduleIfWanted() {
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

absl::Status ClipStream::ScheduleNext(bool continues_call) {
  batching::WindowJob job;
  job.model = model_;
  job.window = clip_.NextWindow();
  job.priority = options_.priority;
  job.deadline = options_.deadline;
  job.cancelled = cancelled_;
  job.window.cancelled = cancelled_;
  job.client = options_.client;
  job.continues_call = continues_call;
  job.call_windows = clip_.window_count();
  job.done = [self = shared_from_this()](const batching::WindowOutcome& outcome) {
    self->OnWindow(outcome);
  };
  expected_frames_ = job.window.leader.frame_count();
  return scheduler_.Submit(std::move(job));
}

void ClipStream::OnWindow(const batching::WindowOutcome& outcome) {
  if (cancelled_->load(std::memory_order_acquire)) return;
  const absl::Status status =
      CheckWindow(outcome.result, expected_frames_, model_->description().skeleton.joint_count());
  motion::Poses frames;
  if (status.ok()) frames = clip_.Accept(*outcome.result);
  if (status.ok()) KeepMeasures();
  Keep(status, frames, outcome.timings);
  ScheduleIfWanted();
  on_progress_();
}

void ClipStream::KeepMeasures() {
  if (clip_.HasNextWindow()) return;
  const std::optional<double> unfamiliarity = model_->Unfamiliarity(clip_.request());
  std::optional<body::Grade> grade = clip_.grade();
  common::MutexLock lock(mutex_);
  stats_.unfamiliarity = unfamiliarity;
  stats_.grade = std::move(grade);
  stats_.pin_distances = clip_.pin_distances();
}

void ClipStream::Keep(const absl::Status& status, const motion::Poses& frames,
                      const batching::WindowTimings& timings) {
  common::MutexLock lock(mutex_);
  in_flight_ = false;
  error_ = status;
  stats_.windows += status.ok() ? 1 : 0;
  stats_.queue_seconds += timings.queue_seconds;
  stats_.compute_seconds += timings.compute_seconds;
  ready_.DropFront(taken_);
  taken_ = 0;
  ready_.Append(frames.all());
  stats_.peak_buffered_frames = std::max(stats_.peak_buffered_frames, ready_.frame_count());
}

}  // namespace duet::server::service
