#include <algorithm>
#include <cmath>
#include <optional>

#include "model/base/angle.h"
#include "model/base/index.h"
#include "model/retargeting/rig_fitting.h"

namespace duet::retargeting {
namespace {

// Weight that decides a branch's rotation only if its neighbours are on one line.
constexpr double kBranchPrior = 1e-3;
// The upper limb always keeps its direction. The weight of the plane is sin^2 of the bend, so that
// below about 10 degrees, where noise dominates it, the past and the plain swing decide.
constexpr double kDirectionWeight = 10;
constexpr double kPreviousPrior = 0.05;
constexpr double kSwingPrior = 0.02;
// So many twists are tried where a joint would turn too fast.
constexpr int kTwists = 17;

using base::Index;

// The axis about which a limb's next joint bends in the rest pose: elbows of a T pose bend about
// the vertical, knees about the line through both.
Vec3d HingeAxis(Vec3d rest_direction) {
  const Vec3d axis = std::abs(rest_direction.y) > 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  return Unit(axis - rest_direction * Dot(axis, rest_direction), axis);
}

Quaternion FitBranch(const RigJoint& joint, Quaternion to_parent, Quaternion previous,
                     absl::Span<const motion::Vec3> positions) {
  std::vector<Correspondence> shape;
  double size = 0;
  for (std::size_t k = 0; k < joint.neighbours.size(); ++k) {
    const Vec3d offset =
        ToDouble(positions[Index(joint.neighbours[k])]) - ToDouble(positions[Index(joint.joint)]);
    shape.push_back({joint.rest_shape[k], Rotate(to_parent, offset), 1});
    size += Dot(joint.rest_shape[k], joint.rest_shape[k]);
  }
  return FitRotation(shape, {{previous, kBranchPrior * size + 1e-12}});
}

}  // namespace

PoseFitter::PoseFitter(const Rig& rig, double frame_rate_hz, BoneLengths lengths)
    : rig_(rig),
      max_twist_(base::kRadiansPerDegree * std::min(kMaxTwist, kMaxTwistSpeed / frame_rate_hz)),
      max_turn_(base::kRadiansPerDegree * kMaxTurnSpeed / frame_rate_hz),
      lengths_(lengths),
      world_(rig.joints.size()),
      aims_(rig.joints.size(), -1) {
  pose_.rotations.resize(rig.joints.size());
  pose_.translations.resize(rig.joints.size());
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    const int parent = rig.joints[j].parent;
    if (parent < 0 || rig.joints[Index(parent)].kind != RigJoint::Kind::kAim) continue;
    const bool aims = rig.joints[j].kind == RigJoint::Kind::kAim;
    if (aims) aims_[Index(parent)] = static_cast<int>(j);
  }
}

const RigPose& PoseFitter::Fit(absl::Span<const motion::Vec3> positions) {
  const std::size_t count = rig_.joints.size();
  std::vector<Vec3d> stands_at(count);
  pose_.root_position = ToDouble(positions[Index(rig_.joints[0].joint)]);
  for (std::size_t j = 0; j < count; ++j) {
    const RigJoint& joint = rig_.joints[j];
    const std::size_t parent = static_cast<std::size_t>(joint.parent);
    const Quaternion parent_world = joint.parent < 0 ? Quaternion{} : world_[parent];
    const Quaternion to_parent = Inverse(parent_world);
    const Vec3d above = joint.parent < 0 ? Vec3d{} : stands_at[parent];
    if (joint.parent < 0 || lengths_ == BoneLengths::kCaptured) {
      stands_at[j] = ToDouble(positions[Index(joint.joint)]);
    } else {
      stands_at[j] = above + Rotate(parent_world, joint.offset);
    }
    pose_.translations[j] = Rotate(to_parent, stands_at[j] - above);
    Quaternion& rotation = pose_.rotations[j];
    if (joint.kind == RigJoint::Kind::kBranch) {
      rotation = FitBranch(joint, to_parent, rotation, positions);
    } else if (joint.kind == RigJoint::Kind::kAim) {
      rotation = FitAim(joint, stands_at[j], to_parent, rotation, positions);
      if (!first_) {
        rotation = to_parent * LimitTwist(j, to_parent, parent_world * rotation, positions);
      }
    }
    world_[j] = parent_world * rotation;
  }
  first_ = false;
  return pose_;
}

Quaternion PoseFitter::FitAim(const RigJoint& joint, Vec3d stands_at, Quaternion to_parent,
                              Quaternion previous, absl::Span<const motion::Vec3> positions) const {
  const Vec3d target = ToDouble(positions[Index(joint.aim)]);
  const Vec3d direction =
      Unit(Rotate(to_parent, target - stands_at), Rotate(previous, joint.rest_direction));
  const Quaternion swing =
      ShortestArc(joint.rest_direction, direction, HingeAxis(joint.rest_direction));
  if (joint.bend < 0) return swing;
  const Vec3d next_bone = Rotate(to_parent, ToDouble(positions[Index(joint.bend)]) - target);
  return FitBend(joint, direction, next_bone, swing, previous);
}

Quaternion PoseFitter::FitBend(const RigJoint& joint, Vec3d direction, Vec3d next_bone,
                               Quaternion swing, Quaternion previous) const {
  const Vec3d rest_axis = HingeAxis(joint.rest_direction);
  Vec3d axis = Cross(direction, Unit(next_bone, direction));
  const double plane_weight = Dot(axis, axis);
  // In a noisy capture, straight limbs bend in the wrong direction: ignore the sign of the plane.
  const Vec3d expected = Rotate(first_ ? swing : previous, rest_axis);
  axis = Unit(Dot(axis, expected) < 0 ? -axis : axis, expected);
  // The twist of the swing flips opposite to the limb's rest direction, so it fades out there.
  const double swing_weight = kSwingPrior * (1 + Dot(joint.rest_direction, direction)) / 2;
  const Quaternion fit = FitRotation(
      {{joint.rest_direction, direction, kDirectionWeight}, {rest_axis, axis, plane_weight}},
      {{previous, first_ ? 0 : kPreviousPrior}, {swing, swing_weight}});
  // Points exactly in the direction, with the twist of the fit.
  return ShortestArc(Rotate(fit, joint.rest_direction), direction, axis) * fit;
}

// Rotations in the world, so that a trunk that turns over in one frame does not take limbs along.
Quaternion PoseFitter::LimitTwist(std::size_t j, Quaternion to_parent, Quaternion fit,
                                  absl::Span<const motion::Vec3> positions) const {
  const RigJoint& joint = rig_.joints[j];
  const Quaternion previous = world_[j];
  const Vec3d direction = Rotate(fit, joint.rest_direction);
  const Vec3d before = Rotate(previous, joint.rest_direction);
  const Quaternion carried =
      ShortestArc(before, direction, Rotate(previous, HingeAxis(joint.rest_direction))) * previous;
  const Quaternion twist = fit * Inverse(carried);
  const double angle = 2 * std::atan2(Dot(Vec3d{twist.x, twist.y, twist.z}, direction), twist.w);
  const double shorter = std::remainder(angle, 2 * base::kPi);
  const bool far = std::abs(shorter) > max_twist_;
  const double wanted = std::clamp(shorter, -max_twist_, max_twist_);
  const auto twisted = [&](double by) { return AxisAngle(direction, by) * carried; };
  const Quaternion limited = far ? twisted(wanted) : fit;
  if (joint.bend < 0) return limited;
  const Vec3d next_bone =
      ToDouble(positions[Index(joint.bend)]) - ToDouble(positions[Index(joint.aim)]);
  const auto too_fast = [&](Quaternion world) {
    return LargestTurn(j, to_parent, world, next_bone) > max_turn_;
  };
  if (!too_fast(limited)) return limited;
  // The nearest twist with which no joint is too fast, if there is one.
  std::optional<double> best;
  for (int n = 0; n < kTwists; ++n) {
    const double by = max_twist_ * (2.0 * n / (kTwists - 1) - 1);
    const bool nearer = !best || std::abs(by - wanted) < std::abs(*best - wanted);
    if (nearer && !too_fast(twisted(by))) best = by;
  }
  return best ? twisted(*best) : limited;
}

double PoseFitter::LargestTurn(std::size_t j, Quaternion to_parent, Quaternion world,
                               Vec3d next_bone) const {
  const double own = Angle(pose_.rotations[j], to_parent * world);
  if (aims_[j] < 0) return own;
  const std::size_t next = Index(aims_[j]);
  const Vec3d rest = rig_.joints[next].rest_direction;
  const Vec3d direction = Unit(Rotate(Inverse(world), next_bone), rest);
  return std::max(own, Angle(pose_.rotations[next], ShortestArc(rest, direction, HingeAxis(rest))));
}

}  // namespace duet::retargeting
