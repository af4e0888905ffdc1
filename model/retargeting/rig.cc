#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/median.h"
#include "model/retargeting/rig_fitting.h"

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

  bool IsAtOrBelow(int joint, int ancestor) const {
    while (joint != ancestor && joint >= 0) joint = parents_[static_cast<size_t>(joint)];
    return joint == ancestor;
  }

  bool IsLeg(int joint) const {
    return skeleton_.hips &&
           (IsAtOrBelow(joint, skeleton_.hips->left) || IsAtOrBelow(joint, skeleton_.hips->right));
  }

  bool LeadsToAHip(int joint) const {
    return skeleton_.hips &&
           (IsAtOrBelow(skeleton_.hips->left, joint) || IsAtOrBelow(skeleton_.hips->right, joint));
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

}  // namespace duet::retargeting
