#include "model/retargeting/rig_animation.h"

#include <algorithm>
#include <cstddef>

#include "model/base/index.h"
#include "model/retargeting/foot_pose.h"
#include "model/retargeting/rig_fitting.h"

namespace duet::retargeting {
namespace {

// Metres, and radians.
constexpr double kSamePlace = 2e-5, kNoTurn = 1e-6;

using base::Index;

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
