#include "model/cleanup/spacing.h"

#include <algorithm>
#include <cstddef>

#include "model/cleanup/directions.h"
#include "model/cleanup/low_pass.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

// The distance that the correction approaches, as a fraction of the maximum distance.
constexpr float kSoftness = 1.1f;

Vec3 ShiftFor(Vec3 offset, const SpacingOptions& options) {
  const float distance = Norm(offset);
  if (distance < kNoOffset) return {};
  const float farthest = static_cast<float>(options.farthest_metres);
  const float target = std::max(static_cast<float>(options.nearest_metres),
                                SoftLimit(distance, farthest, farthest * kSoftness));
  return offset * (target / distance - 1);
}

// The leader's mean speed along the floor, metres per second.
double LeaderSpeed(int root, const motion::Poses& leader, const Timing& timing) {
  const int last = leader.frame_count() - 1;
  if (last < 1) return 0;
  return Norm(Level(leader.at(last, root) - leader.at(0, root))) * timing.frame_rate_hz / last;
}

}  // namespace

void ShiftBody(const std::vector<Vec3>& shifts, double fastest_metres_per_second,
               const Timing& timing, motion::Poses* poses) {
  const float step = static_cast<float>(fastest_metres_per_second / timing.frame_rate_hz);
  Vec3 shift = timing.settled == 0 ? shifts.front() : Vec3{};
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const Vec3 way = shifts[static_cast<std::size_t>(t)] * EaseIn(timing, t) - shift;
    const float length = Norm(way);
    shift += length > step ? way * (step / length) : way;
    for (Vec3& joint : (*poses)[t]) joint += shift;
  }
}

void KeepSpacing(int root, const motion::Poses& leader, const SpacingOptions& options,
                 const Timing& timing, motion::Poses* follower) {
  std::vector<Vec3> shifts;
  for (int t = 0; t < follower->frame_count(); ++t) {
    shifts.push_back(Level(follower->at(t, root) - leader.at(t, root)));
  }
  shifts = LowPass(shifts, timing.Frames(options.sigma_seconds));
  for (Vec3& shift : shifts) shift = ShiftFor(shift, options);
  const double fastest =
      std::min(options.fastest_metres_per_second,
               LeaderSpeed(root, leader, timing) + options.faster_metres_per_second);
  ShiftBody(shifts, fastest, timing, follower);
}

}  // namespace duet::cleanup
