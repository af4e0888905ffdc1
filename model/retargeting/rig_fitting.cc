#include "model/retargeting/rig_fitting.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/angle.h"
#include "model/base/index.h"
#include "model/base/median.h"
#include "model/retargeting/foot_pose.h"
#include "model/retargeting/joint_mapping.h"

namespace duet::retargeting {
namespace {

constexpr Vec3d kRight = {-1, 0, 0}, kUp = {0, 1, 0}, kDown = {0, -1, 0}, kForward = {0, 0, 1};
// Length of the last bone: a hand, a foot, the upper half of the head.
constexpr double kEndSiteLength = 0.35;

class RigBuilder {
 public:
  RigBuilder(const motion::Skeleton& skeleton, const motion::Clip& clip)
      : skeleton_(skeleton), clip_(clip), parents_(skeleton.Parents()) {
    children_.resize(parents_.size());
    for (const motion::Bone& bone : skeleton.bones) {
      children_[static_cast<size_t>(bone.parent)].push_back(bone.child);
    }
    FindTrunkAxes();
  }

  Rig Build() {
    AddJoint(skeleton_.root, -1, {}, kUp);
    return std::move(rig_);
  }

 private:
  const std::vector<int>& Children(int joint) const {
    return children_[static_cast<size_t>(joint)];
  }

  bool IsLeg(int joint) const {
    return skeleton_.hips && (IsAtOrBelow(parents_, joint, skeleton_.hips->left) ||
                              IsAtOrBelow(parents_, joint, skeleton_.hips->right));
  }

  bool LeadsToAHip(int joint) const {
    return skeleton_.hips && (IsAtOrBelow(parents_, skeleton_.hips->left, joint) ||
                              IsAtOrBelow(parents_, skeleton_.hips->right, joint));
  }

  // The root's child that leads upwards; -1 if every child leads to a hip.
  int UpperNeighbour() const {
    for (int child : Children(skeleton_.root)) {
      if (!LeadsToAHip(child)) return child;
    }
    return -1;
  }

  // For every frame, the rotation from the rest pose's trunk to the clip's.
  void FindTrunkAxes() {
    const int upper = UpperNeighbour();
    trunk_axes_.reserve(static_cast<size_t>(clip_.frame_count()));
    for (int frame = 0; frame < clip_.frame_count(); ++frame) {
      // Without hips, the trunk keeps the rest pose's lateral axis.
      const motion::JointPair hips =
          skeleton_.hips.value_or(motion::JointPair{skeleton_.root, skeleton_.root});
      const Vec3d left = ToDouble(clip_.at(frame, hips.left));
      const Vec3d right = ToDouble(clip_.at(frame, hips.right));
      const Vec3d up = upper < 0 ? kUp : ToDouble(clip_.at(frame, upper)) - (left + right) * 0.5;
      const Vec3d x = Unit(left - right, -kRight);
      const Vec3d z = Unit(Cross(x, up), kForward);
      trunk_axes_.push_back(FromAxes(x, Cross(z, x), z));
    }
  }

  double MedianLength(int from, int to) const {
    std::vector<double> lengths;
    lengths.reserve(static_cast<size_t>(clip_.frame_count()));
    for (int frame = 0; frame < clip_.frame_count(); ++frame) {
      lengths.push_back(Norm(ToDouble(clip_.at(frame, to)) - ToDouble(clip_.at(frame, from))));
    }
    return base::Median(std::move(lengths));
  }

  // The mean offset of `to` from `from` in the trunk's axes.
  Vec3d MeanOffset(int from, int to) const {
    Vec3d sum;
    for (int frame = 0; frame < clip_.frame_count(); ++frame) {
      const Vec3d offset = ToDouble(clip_.at(frame, to)) - ToDouble(clip_.at(frame, from));
      sum += Rotate(Inverse(trunk_axes_[static_cast<size_t>(frame)]), offset);
    }
    return sum * (1.0 / clip_.frame_count());
  }

  // The rest direction of the limb that starts at `joint`; `first` leads to its start.
  Vec3d LimbDirection(int joint, Vec3d first) const {
    if (IsLeg(joint)) return kDown;
    if (std::abs(first.x) > std::abs(first.y)) return first.x > 0 ? -kRight : kRight;
    return first.y < 0 ? kDown : kUp;
  }

  // Children and parent. At the root also the children of branching children, so that the shoulders
  // influence the direction of the chest.
  std::vector<int> Neighbours(int joint) const {
    std::vector<int> neighbours = Children(joint);
    const int parent = parents_[static_cast<size_t>(joint)];
    if (parent >= 0) neighbours.push_back(parent);
    if (joint != skeleton_.root) return neighbours;
    for (int child : Children(joint)) {
      const std::vector<int>& further = Children(child);
      if (further.size() > 1) neighbours.insert(neighbours.end(), further.begin(), further.end());
    }
    return neighbours;
  }

  int Push(RigJoint joint) {
    rig_.joints.push_back(std::move(joint));
    return static_cast<int>(rig_.joints.size()) - 1;
  }

  // `limb` is the direction in which a chain of single children continues.
  void AddJoint(int joint, int parent, Vec3d offset, Vec3d limb) {
    RigJoint added;
    added.name = skeleton_.joint_names[static_cast<size_t>(joint)];
    added.parent = parent;
    added.joint = joint;
    added.offset = offset;
    switch (Children(joint).size()) {
      case 0:
        return AddLeaf(std::move(added), limb);
      case 1:
        return AddLimbJoint(std::move(added), limb);
      default:
        return AddBranch(std::move(added));
    }
  }

  void AddLeaf(RigJoint leaf, Vec3d limb) {
    const bool foot = skeleton_.feet &&
                      (leaf.joint == skeleton_.feet->left || leaf.joint == skeleton_.feet->right);
    const double length = kEndSiteLength * Norm(leaf.offset);
    leaf.kind = RigJoint::Kind::kLeaf;
    leaf.end_offset = (foot ? kForward : limb) * length;
    Push(std::move(leaf));
  }

  void AddLimbJoint(RigJoint added, Vec3d limb) {
    const int joint = added.joint, child = Children(joint)[0];
    added.kind = RigJoint::Kind::kAim;
    added.aim = child;
    added.rest_direction = limb;
    if (Children(child).size() == 1) added.bend = Children(child)[0];
    const int index = Push(std::move(added));
    AddJoint(child, index, limb * MedianLength(joint, child), limb);
  }

  void AddBranch(RigJoint branch) {
    const int joint = branch.joint;
    branch.kind = RigJoint::Kind::kBranch;
    branch.neighbours = Neighbours(joint);
    for (int neighbour : branch.neighbours) {
      branch.rest_shape.push_back(MeanOffset(joint, neighbour));
    }
    const int index = Push(std::move(branch));
    for (int child : Children(joint)) AddHelper(joint, index, child);
  }

  void AddHelper(int joint, int parent, int child) {
    RigJoint helper;
    helper.name = absl::StrCat(skeleton_.joint_names[static_cast<size_t>(joint)], "_to_",
                               skeleton_.joint_names[static_cast<size_t>(child)]);
    helper.kind = RigJoint::Kind::kAim;
    helper.parent = parent;
    helper.joint = joint;
    helper.aim = child;
    helper.rest_direction = Unit(MeanOffset(joint, child), kUp);
    const Vec3d direction = helper.rest_direction;
    const int index = Push(std::move(helper));
    AddJoint(child, index, direction * MedianLength(joint, child), LimbDirection(child, direction));
  }

  const motion::Skeleton& skeleton_;
  const motion::Clip& clip_;
  std::vector<int> parents_;
  std::vector<std::vector<int>> children_;
  std::vector<Quaternion> trunk_axes_;  // [frames]
  Rig rig_;
};

}  // namespace

Rig MakeRig(const motion::Skeleton& skeleton, const motion::Clip& clip) {
  return RigBuilder(skeleton, clip).Build();
}

void SetBoneLengths(absl::Span<const motion::Vec3> pose, Rig* rig) {
  for (RigJoint& joint : rig->joints) {
    if (joint.parent < 0) continue;
    const RigJoint& parent = rig->joints[static_cast<size_t>(joint.parent)];
    if (parent.joint == joint.joint) continue;  // a helper, at its parent's position
    const double length = Norm(ToDouble(pose[static_cast<size_t>(joint.joint)]) -
                               ToDouble(pose[static_cast<size_t>(parent.joint)]));
    joint.offset = Unit(joint.offset, parent.rest_direction) * length;
  }
}

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

namespace {

using base::Index;

bool IsFoot(const motion::Skeleton& skeleton, int joint) {
  return skeleton.feet && (joint == skeleton.feet->left || joint == skeleton.feet->right);
}

// The rotation on the way from one to another that is at most `most` radians from the first.
Quaternion Towards(Quaternion from, Quaternion to, double most) {
  const double way = Angle(from, to);
  return way <= most ? to : Slerp(from, to, most / way);
}

void KeepSigns(const std::vector<Quaternion>& previous, std::vector<Quaternion>* rotations) {
  for (std::size_t j = 0; j < rotations->size(); ++j) {
    Quaternion& q = (*rotations)[j];
    if (Dot(q, previous[j]) < 0) q = {-q.w, -q.x, -q.y, -q.z};
  }
}

}  // namespace

RigFitter::RigFitter(const motion::Skeleton& skeleton, const Rig& rig, double frame_rate_hz,
                     double ankle_height_on_floor, BoneLengths lengths)
    : rig_(rig),
      ankle_height_(ankle_height_on_floor),
      max_foot_turn_(base::kRadiansPerDegree * kMaxFootSpeed / frame_rate_hz),
      fitter_(rig, frame_rate_hz, lengths) {
  for (const RigJoint& joint : rig.joints) {
    feet_.push_back(joint.kind == RigJoint::Kind::kLeaf && IsFoot(skeleton, joint.joint));
  }
}

const RigPose& RigFitter::Fit(absl::Span<const motion::Vec3> positions) {
  const std::vector<Quaternion> previous = std::move(pose_.rotations);
  pose_ = fitter_.Fit(positions);
  TurnFeet(previous);
  if (!first_) KeepSigns(previous, &pose_.rotations);
  first_ = false;
  return pose_;
}

// The fit leaves feet at rest relative to their shins.
void RigFitter::TurnFeet(const std::vector<Quaternion>& previous) {
  std::vector<Quaternion> world(rig_.joints.size());
  std::vector<Vec3d> at(rig_.joints.size());
  for (std::size_t j = 0; j < rig_.joints.size(); ++j) {
    const int parent = rig_.joints[j].parent;
    const Quaternion above = parent < 0 ? Quaternion{} : world[Index(parent)];
    at[j] = (parent < 0 ? Vec3d{} : at[Index(parent)]) + Rotate(above, pose_.translations[j]);
    if (feet_[j]) {
      const Quaternion foot = Inverse(above) * FootRotation(above, at[j], ankle_height_);
      pose_.rotations[j] = first_ ? foot : Towards(previous[j], foot, max_foot_turn_);
    }
    world[j] = above * pose_.rotations[j];
  }
}

namespace {

// [rig joints]
std::vector<Quaternion> WorldRotations(const Rig& rig, const RigPose& pose) {
  std::vector<Quaternion> world;
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    const int parent = rig.joints[j].parent;
    const Quaternion local = pose.rotations[j];
    world.push_back(parent < 0 ? local : world[Index(parent)] * local);
  }
  return world;
}

}  // namespace

std::vector<Vec3d> JointPositions(const Rig& rig, const RigPose& pose) {
  const std::vector<Quaternion> world = WorldRotations(rig, pose);
  std::vector<Vec3d> at;
  for (const RigJoint& joint : rig.joints) {
    const int parent = joint.parent;
    at.push_back(parent < 0 ? pose.root_position
                            : at[Index(parent)] + Rotate(world[Index(parent)], joint.offset));
  }
  return at;
}

namespace {

constexpr double kBlockSeconds = 1;

int BlockFrames(double frame_rate_hz) {
  return std::max(1, static_cast<int>(std::lround(kBlockSeconds * frame_rate_hz)));
}

// From `a` (share 0) to `b` (share 1), joint by joint in the world. Both have the same positions.
RigPose Between(const Rig& rig, const RigPose& a, const RigPose& b, double share) {
  const std::vector<Quaternion> world_a = WorldRotations(rig, a), world_b = WorldRotations(rig, b);
  RigPose pose = a;
  std::vector<Quaternion> world;
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    const int parent = rig.joints[j].parent;
    world.push_back(Slerp(world_a[j], world_b[j], share));
    pose.rotations[j] =
        parent < 0 ? world[j] : Inverse(world[static_cast<std::size_t>(parent)]) * world[j];
  }
  return pose;
}

}  // namespace

EndlessRigFitter::EndlessRigFitter(const motion::Skeleton& skeleton, const Rig& rig,
                                   double frame_rate_hz, double ankle_height_on_floor)
    : skeleton_(skeleton),
      rig_(rig),
      frame_rate_hz_(frame_rate_hz),
      ankle_height_(ankle_height_on_floor),
      block_(BlockFrames(frame_rate_hz)),
      older_(NewFitter()),
      younger_(NewFitter()) {}

int EndlessRigFitter::HistoryFrames(double frame_rate_hz) { return 2 * BlockFrames(frame_rate_hz); }

std::unique_ptr<RigFitter> EndlessRigFitter::NewFitter() const {
  return std::make_unique<RigFitter>(skeleton_, rig_, frame_rate_hz_, ankle_height_,
                                     BoneLengths::kRigs);
}

const RigPose& EndlessRigFitter::Fit(int frame, absl::Span<const motion::Vec3> positions) {
  const int since = frame % block_;
  if (since == 0) {
    older_ = std::exchange(younger_, NewFitter());
  }
  const RigPose& from = older_->Fit(positions);
  const RigPose& to = younger_->Fit(positions);
  pose_ = Between(rig_, from, to, static_cast<double>(since) / block_);
  return pose_;
}

namespace {

// Metres, and radians.
constexpr double kSamePlace = 2e-5, kNoTurn = 1e-6;

}  // namespace

std::vector<Vec3d> RestPositions(const Rig& rig) {
  std::vector<Vec3d> positions;
  double lowest = 0;
  for (const RigJoint& joint : rig.joints) {
    const Vec3d above = joint.parent < 0 ? Vec3d{} : positions[Index(joint.parent)];
    positions.push_back(above + joint.offset);
    lowest = std::min(lowest, positions.back().y);
  }
  for (Vec3d& position : positions) position.y -= lowest;
  return positions;
}

Vec3d RigAnimation::RestTranslation(std::size_t joint) const {
  const int parent = rig.joints[joint].parent;
  return parent < 0 ? rest_positions[joint] : rig.joints[joint].offset;
}

bool RigAnimation::KeepsItsPlace(std::size_t joint) const {
  const Vec3d rest = RestTranslation(joint);
  return std::all_of(frames.begin(), frames.end(), [joint, rest](const RigPose& pose) {
    return Norm(pose.translations[joint] - rest) < kSamePlace;
  });
}

bool RigAnimation::NeverTurns(std::size_t joint) const {
  return std::all_of(frames.begin(), frames.end(), [joint](const RigPose& pose) {
    return Angle(pose.rotations[joint], {}) < kNoTurn;
  });
}

RigAnimation AnimateRig(const motion::Skeleton& skeleton, const motion::Clip& clip) {
  RigAnimation animation;
  animation.rig = MakeRig(skeleton, clip);
  animation.rest_positions = RestPositions(animation.rig);
  animation.frame_rate_hz = clip.frame_rate_hz;
  const double ankle_height = AnkleHeightOnFloor(skeleton, clip);
  animation.sole_depth = SoleDepth(ankle_height);
  RigFitter fitter(skeleton, animation.rig, clip.frame_rate_hz, ankle_height,
                   BoneLengths::kCaptured);
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    animation.frames.push_back(fitter.Fit(clip.poses[frame]));
  }
  return animation;
}

}  // namespace duet::retargeting
