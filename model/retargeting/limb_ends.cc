#include "model/retargeting/limb_ends.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/index.h"
#include "model/retargeting/foot_pose.h"

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

namespace {

// Metres. A shorter foot or hand has no direction.
constexpr double kNoLength = 0.01;
// Radians. The slopes of feet that stand at rest, and how far outwards they point.
constexpr double kLeastSlope = -0.2, kMostSlope = 0.9, kMostToeOut = 0.8;

using base::Index;

// The clip's joint in a role that is one joint, which wrists and ankles always are.
int JointOf(const BodyRoles& roles, const char* role) {
  return roles.body.sources[Index(motion::SbuSkeleton().Find(role))].terms[0].joint;
}

// The rig's joint at `tip`, if it is another one than at `end`.
int RigJoint(const CharacterRig& rig, int end, int tip) {
  const auto& at_end = rig.joints.sources[Index(end)].terms;
  const auto& at_tip = rig.joints.sources[Index(tip)].terms;
  if (at_tip.size() != 1 || at_end.size() != 1) return -1;
  for (int joint = rig.parents[Index(at_tip[0].joint)]; joint >= 0;
       joint = rig.parents[Index(joint)]) {
    if (joint == at_end[0].joint) return at_tip[0].joint;
  }
  return -1;
}

}  // namespace

LimbEnds::LimbEnds(const motion::Clip& clip, const BodyRoles& roles, const CharacterRig& rig,
                   absl::Span<const motion::Vec3> landmarks)
    : clip_(clip) {
  ends_[0].ankle = JointOf(roles, "left_foot");
  ends_[1].ankle = JointOf(roles, "right_foot");
  ends_[0].wrist = JointOf(roles, "left_hand");
  ends_[1].wrist = JointOf(roles, "right_hand");
  const auto between = [&landmarks](int from, int to) {
    return ToDouble(landmarks[Index(to)]) - ToDouble(landmarks[Index(from)]);
  };
  if (roles.toes.has_value()) {
    ends_[0].toe = roles.toes->left, ends_[1].toe = roles.toes->right;
    foot_slope_ = FootSlopeOnFloor({ends_[0].ankle, ends_[1].ankle}, *roles.toes, clip);
    toe_height_ = HeightOnFloor(*roles.toes, clip);
  }
  if (roles.hands.has_value())
    ends_[0].hand = roles.hands->left, ends_[1].hand = roles.hands->right;
  for (Ends& ends : ends_) {
    if (ends.toe >= 0) {
      ends.foot_rest = between(ends.ankle, ends.toe);
      ends.rig_toe = RigJoint(rig, ends.ankle, ends.toe);
    }
    if (ends.hand >= 0) ends.hand_rest = between(ends.wrist, ends.hand);
  }
}

Quaternion LimbEnds::FootAtRest(Side side, Quaternion expected, bool flat) const {
  const Ends& ends = At(side);
  if (ends.rig_toe < 0 || Norm(ends.foot_rest) < kNoLength) return expected;
  const Vec3d foot = Rotate(Inverse(expected), ends.foot_rest);
  const double slope = std::atan2(-foot.y, std::hypot(foot.x, foot.z));
  const double outwards = std::atan2(foot.x, foot.z);
  if (flat && slope > kLeastSlope && slope < kMostSlope && std::abs(outwards) < kMostToeOut) {
    return expected * AxisAngle({0, 1, 0}, outwards);
  }
  // A foot that hangs or points elsewhere takes its slope from the clip's.
  return FootRotationWithToe(expected, {}, ends.foot_rest, foot_slope_);
}

Quaternion LimbEnds::Foot(Side side, int frame, Quaternion without_toe) const {
  const Ends& ends = At(side);
  if (ends.toe < 0) return without_toe;
  return FootRotationWithToe(without_toe, Position(frame, ends.ankle), Position(frame, ends.toe),
                             foot_slope_);
}

Quaternion LimbEnds::Toes(Side side, int frame, Quaternion foot) const {
  return FootRotation(foot, Position(frame, At(side).toe), toe_height_);
}

Quaternion LimbEnds::Hand(Side side, int frame, Quaternion forearm) const {
  const Ends& ends = At(side);
  if (ends.hand < 0 || Norm(ends.hand_rest) < kNoLength) return forearm;
  const Vec3d straight = Unit(Rotate(forearm, ends.hand_rest), {0, 1, 0});
  const Vec3d hand = Position(frame, ends.hand) - Position(frame, ends.wrist);
  if (Norm(hand) < kNoLength) return forearm;
  const Vec3d direction = Unit(hand, straight);
  const Vec3d axis = Unit(Cross(straight, Rotate(forearm, {0, 0, 1})), Rotate(forearm, {1, 0, 0}));
  return ShortestArc(straight, direction, axis) * forearm;
}

}  // namespace duet::retargeting
