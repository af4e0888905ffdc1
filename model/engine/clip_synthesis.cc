#include "model/engine/clip_synthesis.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <utility>

#include "model/motion/resample.h"

namespace duet::engine {
namespace {

// Rows of a spline before and after the one that a time falls in.
constexpr int kRowsBefore = 1;
constexpr int kRowsAfter = 2;

}  // namespace

ClipSynthesis::ClipSynthesis(ModelDescription model, ClipRequest request)
    : model_(std::move(model)),
      request_(std::move(request)),
      cross_fade_(model_.skeleton),
      frame_count_(static_cast<int>(request_.leader.size()) / model_.skeleton.joint_count()),
      model_frames_per_frame_(model_.frame_rate_hz / request_.frame_rate_hz),
      plan_(PlanWindows(
          motion::ResampledFrameCount(frame_count_, request_.frame_rate_hz, model_.frame_rate_hz),
          model_.window_frames)) {}

SynthesisWindow ClipSynthesis::NextWindow() const {
  const std::size_t joints = static_cast<std::size_t>(model_.skeleton.joint_count());
  const std::size_t classes = static_cast<std::size_t>(model_.class_count());
  const std::size_t length = static_cast<std::size_t>(plan_.length);
  const int first = plan_.starts[static_cast<std::size_t>(next_window_)];
  SynthesisWindow window;
  window.leader.resize(length * joints);
  window.labels.resize(length * classes);
  for (std::size_t t = 0; t < length; ++t) {
    const double frame = ToCallerFrame(first + static_cast<int>(t));
    SampleLinear(request_.leader, model_.skeleton.joint_count(), frame,
                 window.leader.data() + t * joints);
    request_.labels.At(frame, window.labels.data() + t * classes);
  }
  window.start = NextStart();
  // The characters move: later, where the follower has got to tells the direction.
  if (next_window_ == 0 || !window.start) window.partner_direction = request_.partner_direction;
  return window;
}

std::optional<FollowerStart> ClipSynthesis::NextStart() const {
  if (next_window_ == 0) return request_.start;
  if (!model_.accepts_follower_start) return std::nullopt;
  const int joints = model_.skeleton.joint_count();
  const int row = plan_.starts[static_cast<std::size_t>(next_window_)] - kept_from_;
  const auto pose = kept_.begin() + static_cast<std::ptrdiff_t>(row) * joints;
  return FollowerStart{pose[model_.skeleton.root], {pose, pose + joints}};
}

std::vector<motion::Vec3> ClipSynthesis::Accept(const std::vector<motion::Vec3>& follower) {
  const std::size_t joints = static_cast<std::size_t>(model_.skeleton.joint_count());
  // Only an engine that breaks its contract gets here; going on would read past its result.
  if (!HasNextWindow() || follower.size() != static_cast<std::size_t>(plan_.length) * joints) {
    std::abort();
  }
  Blend(plan_.starts[static_cast<std::size_t>(next_window_)], follower);
  ++next_window_;
  std::vector<motion::Vec3> frames = TakeFinalFrames();
  DropRows();
  return frames;
}

void ClipSynthesis::Blend(int start, const std::vector<motion::Vec3>& follower) {
  const std::ptrdiff_t joints = model_.skeleton.joint_count();
  const std::ptrdiff_t rows = static_cast<std::ptrdiff_t>(kept_.size()) / joints;
  const std::ptrdiff_t first = start - kept_from_;  // row of kept_ where the window begins
  const std::ptrdiff_t shared = rows - first;
  cross_fade_.Blend(kept_.data() + first * joints, follower.data(), static_cast<int>(shared));
  kept_.insert(kept_.end(), follower.begin() + shared * joints, follower.end());
}

std::vector<motion::Vec3> ClipSynthesis::TakeFinalFrames() {
  const int joints = model_.skeleton.joint_count();
  // The next window may change its first frame and all that follow.
  const int final_end = HasNextWindow() ? plan_.starts[static_cast<std::size_t>(next_window_)]
                                        : std::numeric_limits<int>::max();
  std::vector<motion::Vec3> frames;
  std::vector<motion::Vec3> pose(static_cast<std::size_t>(joints));
  for (; next_frame_ < frame_count_; ++next_frame_) {
    const double at = ToModelFrame(next_frame_);
    if (static_cast<int>(at) >= final_end - kRowsAfter) break;
    SampleCubic(kept_, joints, at - kept_from_, pose.data());
    frames.insert(frames.end(), pose.begin(), pose.end());
  }
  return frames;
}

void ClipSynthesis::DropRows() {
  if (!HasNextWindow()) {
    kept_.clear();
    return;
  }
  const int spline = static_cast<int>(ToModelFrame(next_frame_)) - kRowsBefore;
  const int window = plan_.starts[static_cast<std::size_t>(next_window_)];
  const int keep_from = std::max(kept_from_, std::min(spline, window));
  const std::ptrdiff_t dropped = keep_from - kept_from_;
  kept_.erase(kept_.begin(), kept_.begin() + dropped * model_.skeleton.joint_count());
  kept_from_ = keep_from;
}

}  // namespace duet::engine
