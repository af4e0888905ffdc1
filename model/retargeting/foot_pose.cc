#include "model/retargeting/foot_pose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "model/base/median.h"

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

// Part of all feet that are taken as standing, 1 / kStandingFeet: those with the lowest ankles.
constexpr std::size_t kStandingFeet = 10;
// Weight of the shin's lateral axis beside that of the foot's own direction.
constexpr double kLeftShare = 0.1;

constexpr double kLowestAnkle = 0.01, kHighestAnkle = 0.25;  // above a floor, metres

}  // namespace

double AnkleHeightOnFloor(const motion::Skeleton& skeleton, const motion::Clip& clip) {
  return skeleton.feet ? HeightOnFloor(*skeleton.feet, clip) : 0;
}

double HeightOnFloor(motion::JointPair joints, const motion::Clip& clip) {
  std::vector<double> lowest;
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    lowest.push_back(static_cast<double>(
        std::min(clip.at(frame, joints.left).y, clip.at(frame, joints.right).y)));
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

double FootSlopeOnFloor(motion::JointPair ankles, motion::JointPair toes,
                        const motion::Clip& clip) {
  struct Foot {
    double height, slope;
  };
  std::vector<Foot> feet;
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    for (const auto& [ankle, toe] :
         {std::pair(ankles.left, toes.left), std::pair(ankles.right, toes.right)}) {
      const Vec3d at = ToDouble(clip.at(frame, ankle)), foot = ToDouble(clip.at(frame, toe)) - at;
      feet.push_back({at.y, std::atan2(-foot.y, std::hypot(foot.x, foot.z))});
    }
  }
  const std::size_t standing = 1 + feet.size() / kStandingFeet;
  std::partial_sort(feet.begin(), feet.begin() + static_cast<std::ptrdiff_t>(standing), feet.end(),
                    [](const Foot& a, const Foot& b) { return a.height < b.height; });
  std::vector<double> slopes;
  for (std::size_t i = 0; i < standing; ++i) slopes.push_back(feet[i].slope);
  return base::Median(std::move(slopes));
}

Quaternion FootRotationWithToe(Quaternion without_toe, Vec3d ankle, Vec3d toe,
                               double slope_on_floor) {
  const Vec3d up = Rotate(without_toe, {0, 1, 0}), left = Rotate(without_toe, {1, 0, 0});
  const Vec3d along = Unit(toe - ankle, Rotate(without_toe, {0, 0, 1}));
  // The cross product vanishes if the foot points down its shin; `left` then decides.
  const Vec3d across = Cross(up, along) + left * kLeftShare;
  const Vec3d x = Unit(across - along * Dot(across, along), left);
  const Quaternion foot = FromAxes(x, Cross(along, x), along);
  return foot * AxisAngle({1, 0, 0}, -slope_on_floor);
}

}  // namespace duet::retargeting
