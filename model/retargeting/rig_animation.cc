#include "model/retargeting/rig_animation.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "model/retargeting/foot_pose.h"

namespace duet::retargeting {
namespace {

// Metres, and radians.
constexpr double kSamePlace = 2e-5, kNoTurn = 1e-6;

std::size_t Index(int joint) { return static_cast<std::size_t>(joint); }

bool IsFoot(const motion::Skeleton& skeleton, int joint) {
  return skeleton.feet && (joint == skeleton.feet->left || joint == skeleton.feet->right);
}

// Rotates feet, which the fit leaves at rest relative to their shins.
void TurnFeet(const motion::Skeleton& skeleton, const Rig& rig, double ankle_height,
              RigPose* pose) {
  std::vector<Quaternion> world(rig.joints.size());
  std::vector<Vec3d> at(rig.joints.size());
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    const RigJoint& joint = rig.joints[j];
    const Quaternion above = joint.parent < 0 ? Quaternion{} : world[Index(joint.parent)];
    at[j] = (joint.parent < 0 ? Vec3d{} : at[Index(joint.parent)]) +
            Rotate(above, pose->translations[j]);
    if (joint.kind == RigJoint::Kind::kLeaf && IsFoot(skeleton, joint.joint)) {
      pose->rotations[j] = Inverse(above) * FootRotation(above, at[j], ankle_height);
    }
    world[j] = above * pose->rotations[j];
  }
}

void KeepSigns(const RigPose& previous, RigPose* pose) {
  for (std::size_t j = 0; j < pose->rotations.size(); ++j) {
    Quaternion& q = pose->rotations[j];
    if (Dot(q, previous.rotations[j]) < 0) q = {-q.w, -q.x, -q.y, -q.z};
  }
}

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
  PoseFitter fitter(animation.rig, BoneLengths::kCaptured);
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    RigPose pose = fitter.Fit(clip.poses[frame]);
    TurnFeet(skeleton, animation.rig, ankle_height, &pose);
    if (frame > 0) KeepSigns(animation.frames.back(), &pose);
    animation.frames.push_back(std::move(pose));
  }
  return animation;
}

}  // namespace duet::retargeting
