#include "model/engine/clip_synthesis.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <utility>

#include "model/engine/window_seed.h"
#include "model/motion/resample.h"

namespace duet::engine {
namespace {

// Frames of a spline before and after the one that a time falls in.
constexpr int kFramesBefore = 1;
constexpr int kFramesAfter = 2;

bool GoesOnFromSettledFrames(const ModelDescription& model) {
  return model.samples && model.accepts_follower_start;
}

int Overlap(const ModelDescription& model) {
  return GoesOnFromSettledFrames(model) ? SettledOverlap(model.window_frames)
                                        : CrossFadeOverlap(model.window_frames);
}

}  // namespace

ClipSynthesis::ClipSynthesis(ModelDescription model, ClipRequest request)
    : model_(std::move(model)),
      request_(std::move(request)),
      cross_fade_(model_.skeleton),
      frame_count_(request_.leader.frame_count()),
      model_frames_per_frame_(model_.frame_rate_hz / request_.frame_rate_hz),
      plan_(PlanWindows(
          motion::ResampledFrameCount(frame_count_, request_.frame_rate_hz, model_.frame_rate_hz),
          model_.window_frames, Overlap(model_))),
      kept_(0, model_.skeleton.joint_count()) {}

SynthesisWindow ClipSynthesis::NextWindow() const {
  const std::size_t classes = model_.classes.size();
  const int first = plan_.starts[static_cast<std::size_t>(next_window_)];
  SynthesisWindow window;
  window.leader = motion::Poses(plan_.length, model_.skeleton.joint_count());
  window.labels.resize(static_cast<std::size_t>(plan_.length) * classes);
  for (int t = 0; t < plan_.length; ++t) {
    const double frame = ToCallerFrame(first + t);
    SampleLinear(request_.leader, frame, window.leader[t]);
    request_.labels.At(frame, window.labels.data() + static_cast<std::size_t>(t) * classes);
  }
  window.start = NextStart();
  // The characters move: later, where the follower has got to tells the direction.
  if (next_window_ == 0 || !window.start) window.partner_direction = request_.partner_direction;
  if (!window.start && !window.partner_direction && model_.partner_direction) {
    window.partner_direction =
        EstimatePartnerDirection(*model_.partner_direction, model_.skeleton, window.leader);
  }
  window.options = request_.options;
  window.options.sampling.seed = WindowSeed(request_.options.sampling.seed, next_window_);
  window.settled = NextSettled();
  return window;
}

std::optional<FollowerStart> ClipSynthesis::NextStart() const {
  if (next_window_ == 0) return request_.start;
  if (!model_.accepts_follower_start) return std::nullopt;
  const int frame = plan_.starts[static_cast<std::size_t>(next_window_)] - kept_from_;
  const absl::Span<const motion::Vec3> pose = kept_[frame];
  return FollowerStart{kept_.at(frame, model_.skeleton.root), {pose.begin(), pose.end()}};
}

motion::Poses ClipSynthesis::NextSettled() const {
  if (next_window_ == 0 || !GoesOnFromSettledFrames(model_)) return {};
  const int first = plan_.starts[static_cast<std::size_t>(next_window_)] - kept_from_;
  motion::Poses settled(0, model_.skeleton.joint_count());
  settled.Append(kept_.frames(first, kept_.frame_count() - first));
  return settled;
}

motion::Poses ClipSynthesis::Accept(const motion::Poses& follower) {
  // Only an engine that breaks its contract gets here; going on would read past its result.
  if (!HasNextWindow() || follower.frame_count() != plan_.length ||
      follower.joint_count() != model_.skeleton.joint_count()) {
    std::abort();
  }
  Blend(plan_.starts[static_cast<std::size_t>(next_window_)], follower);
  ++next_window_;
  motion::Poses frames = TakeFinalFrames();
  DropFrames();
  return frames;
}

void ClipSynthesis::Blend(int start, const motion::Poses& follower) {
  const int first = start - kept_from_;  // frame of kept_ where the window begins
  const int shared = kept_.frame_count() - first;
  cross_fade_.Blend(follower, first, &kept_);
  kept_.Append(follower.frames(shared, follower.frame_count() - shared));
}

motion::Poses ClipSynthesis::TakeFinalFrames() {
  const int joints = model_.skeleton.joint_count();
  // The next window may change its first frame and all that follow.
  const int final_end = HasNextWindow() ? plan_.starts[static_cast<std::size_t>(next_window_)]
                                        : std::numeric_limits<int>::max();
  motion::Poses frames(0, joints);
  std::vector<motion::Vec3> pose(static_cast<std::size_t>(joints));
  for (; next_frame_ < frame_count_; ++next_frame_) {
    const double at = ToModelFrame(next_frame_);
    if (static_cast<int>(at) >= final_end - kFramesAfter) break;
    SampleCubic(kept_, at - kept_from_, absl::MakeSpan(pose));
    frames.Append(pose);
  }
  return frames;
}

void ClipSynthesis::DropFrames() {
  if (!HasNextWindow()) {
    kept_.DropFront(kept_.frame_count());
    return;
  }
  const int spline = static_cast<int>(ToModelFrame(next_frame_)) - kFramesBefore;
  const int window = plan_.starts[static_cast<std::size_t>(next_window_)];
  const int keep_from = std::max(kept_from_, std::min(spline, window));
  kept_.DropFront(keep_from - kept_from_);
  kept_from_ = keep_from;
}

}  // namespace duet::engine
