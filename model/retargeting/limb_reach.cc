#include "model/retargeting/limb_reach.h"

#include <algorithm>
#include <cmath>

namespace duet::retargeting {
namespace {

// Fraction of a limb's length that keeps it from being straight or folded, which has no plane.
constexpr double kSlack = 1e-4;
// Distance of the middle joint from the line between the ends, as a fraction of the limb. Below the
// first, the limb defines no direction; above the second, it defines it completely.
constexpr double kStraight = 0.02, kBent = 0.12;

double SmoothStep(double from, double to, double at) {
  const double t = std::clamp((at - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Vec3d Across(Vec3d a, Vec3d along) { return a - along * Dot(a, along); }

// Any perpendicular direction.
Vec3d SomeAcross(Vec3d along) {
  const Vec3d axis = std::abs(along.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1};
  return Unit(Across(axis, along), axis);
}

}  // namespace

LimbPose ReachFor(Vec3d start, Vec3d target, double upper_length, double lower_length, Vec3d pole) {
  const Vec3d along = Unit(target - start, {0, -1, 0});
  const Vec3d out = Unit(Across(pole, along), SomeAcross(along));
  const double slack = kSlack * (upper_length + lower_length);
  const double distance =
      std::clamp(Norm(target - start), std::abs(upper_length - lower_length) + slack,
                 upper_length + lower_length - slack);
  const double cosine =
      std::clamp((upper_length * upper_length + distance * distance - lower_length * lower_length) /
                     (2 * upper_length * distance),
                 -1.0, 1.0);
  LimbPose pose;
  pose.upper = along * cosine + out * std::sqrt(1 - cosine * cosine);
  pose.lower = Unit(along * distance - pose.upper * upper_length, along);
  pose.hinge = Cross(out, along);
  return pose;
}

Vec3d PoleTracker::Follow(Vec3d start, Vec3d middle, Vec3d end, Vec3d otherwise) {
  const Vec3d along = Unit(end - start, first_ ? Vec3d{0, -1, 0} : along_);
  const double length = Norm(middle - start) + Norm(end - middle);
  const Vec3d out = Across(middle - start, along);
  Vec3d kept = otherwise;
  if (!first_) kept = Rotate(ShortestArc(along_, along, SomeAcross(along_)), pole_);
  kept = Unit(Across(kept, along), SomeAcross(along));
  const double share = length > 0 ? SmoothStep(kStraight, kBent, Norm(out) / length) : 0.0;
  // Along the shorter arc, so that opposite directions do not cancel.
  const Vec3d said = Unit(out, kept);
  const Quaternion whole = ShortestArc(kept, said, along);
  const double angle = Angle(whole, {}) * share;
  const Vec3d axis = Unit(Vec3d{whole.x, whole.y, whole.z} * (whole.w < 0 ? -1.0 : 1.0), along);
  pole_ = Rotate(AxisAngle(axis, angle), kept);
  along_ = along;
  first_ = false;
  return pole_;
}

}  // namespace duet::retargeting
