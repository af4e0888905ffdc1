#include "model/retargeting/rig_animation.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "model/base/angle.h"
#include "model/base/index.h"
#include "model/retargeting/foot_pose.h"

namespace duet::retargeting {
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
