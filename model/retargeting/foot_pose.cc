#include "model/retargeting/foot_pose.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace duet::retargeting {
namespace {

// Fraction of frames that may be below the floor, because captures jitter.
constexpr double kFloorShare = 0.02;
// Metres above the floor. Below the first, a foot is level; above the second, it follows its shin.
constexpr double kStands = 0.03, kInTheAir = 0.18;
// Cosine of the shin's lean. The feet of a person who kneels or lies are not level.
constexpr double kLying = 0.1, kUpright = 0.6;

double SmoothStep(double from, double to, double at) {
  const double t = std::clamp((at - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

constexpr double kLowestAnkle = 0.01, kHighestAnkle = 0.25;  // above a floor, metres

}  // namespace

double AnkleHeightOnFloor(const motion::Skeleton& skeleton, const motion::Clip& clip) {
  if (!skeleton.feet) return 0;
  std::vector<double> lowest;
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    lowest.push_back(static_cast<double>(
        std::min(clip.at(frame, skeleton.feet->left).y, clip.at(frame, skeleton.feet->right).y)));
  }
  const auto low = lowest.begin() +
                   static_cast<std::ptrdiff_t>(kFloorShare * static_cast<double>(lowest.size()));
  std::nth_element(lowest.begin(), low, lowest.end());
  return *low;
}

double SoleDepth(double ankle_height_on_floor) {
  const bool on_floor =
      ankle_height_on_floor >= kLowestAnkle && ankle_height_on_floor <= kHighestAnkle;
  return on_floor ? ankle_height_on_floor : kUsualAnkleHeight;
}

Quaternion FootRotation(Quaternion shin, Vec3d ankle, double ankle_height_on_floor) {
  const Vec3d up = {0, 1, 0};
  const Vec3d along_shin = Rotate(shin, up), ahead = Rotate(shin, {0, 0, 1});
  const double share = (1 - SmoothStep(kStands, kInTheAir, ankle.y - ankle_height_on_floor)) *
                       SmoothStep(kLying, kUpright, along_shin.y);
  const Vec3d level = Unit({ahead.x, 0, ahead.z}, ahead);
  const Vec3d y = Unit(along_shin * (1 - share) + up * share, along_shin);
  const Vec3d mixed = ahead * (1 - share) + level * share;
  const Vec3d z = Unit(mixed - y * Dot(mixed, y), ahead);
  return FromAxes(Cross(y, z), y, z);
}

}  // namespace duet::retargeting
