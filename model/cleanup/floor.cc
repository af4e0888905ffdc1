#include "model/cleanup/floor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "model/cleanup/low_pass.h"
#include "model/motion/feet.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {
namespace {

// Steps in height are not copied into the correction.
constexpr double kSmoothSeconds = 0.1;

// For each frame, the largest minimum of the runs of `length` frames that contain it: truncates
// peaks that are shorter than `length`.
std::vector<float> CutShortRises(const std::vector<float>& track, int length) {
  const int frames = static_cast<int>(track.size());
  length = std::clamp(length, 1, frames);
  std::vector<float> level(track.size());
  for (int t = 0; t < frames; ++t) {
    float highest = -INFINITY;
    for (int first = std::max(0, t - length + 1); first <= std::min(t, frames - length); ++first) {
      const auto run = track.begin() + first;
      highest = std::max(highest, *std::min_element(run, run + length));
    }
    level[static_cast<std::size_t>(t)] = highest;
  }
  return level;
}

// The correction of a height relative to the floor.
float Lift(float height, const FloorOptions& options) {
  const float allowed = SoftLimit(std::abs(height), static_cast<float>(options.free_metres),
                                  static_cast<float>(options.most_metres));
  return std::copysign(allowed, height) - height;
}

}  // namespace

float FloorHeight(const motion::JointPair& feet, const motion::Poses& poses) {
  std::vector<float> heights = LowerFoot(feet, poses);
  const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 10);
  std::nth_element(heights.begin(), low, heights.end());
  return *low;
}

void StandOnFloor(const motion::Skeleton& skeleton, float floor, const FloorOptions& options,
                  const Timing& timing, motion::Poses* poses) {
  if (!skeleton.feet) return;
  std::vector<float> heights =
      CutShortRises(LowerFoot(*skeleton.feet, *poses),
                    static_cast<int>(std::lround(timing.Frames(options.jump_seconds))));
  heights = LowPass(heights, timing.Frames(kSmoothSeconds));
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const float lift = Lift(heights[static_cast<std::size_t>(t)] - floor, options);
    for (motion::Vec3& joint : (*poses)[t]) joint.y += lift * EaseIn(timing, t);
  }
}

}  // namespace duet::cleanup
