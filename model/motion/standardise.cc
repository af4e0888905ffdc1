#include "model/motion/standardise.h"

#include <cmath>

namespace duet::motion {
namespace {

// The yaw for the leader's left-to-right hip direction in the first frame.
double HipYaw(Vec3 across, YawDirection direction) {
  // Hips that coincide (a degenerate leader) have no direction: do not rotate the clip.
  if (across.x == 0 && across.z == 0) return 0;
  // The published code takes the arc tangent of the quotient, which is equal for opposite
  // directions, and rotates in the wrong direction.
  if (direction == YawDirection::kAsReleasedCode) return -std::atan(across.z / across.x);
  return std::atan2(across.z, across.x);
}

double HipYaw(const Skeleton& skeleton, const Poses& leader, YawDirection direction) {
  if (!skeleton.hips) return 0;
  return HipYaw(leader.at(0, skeleton.hips->right) - leader.at(0, skeleton.hips->left), direction);
}

}  // namespace

double FacingYaw(Vec3 direction) { return std::atan2(direction.x, -direction.z); }

Standardisation::Standardisation(const Skeleton& skeleton, const Poses& leader,
                                 YawDirection direction, StandardOrigin origin)
    : Standardisation(skeleton, leader, HipYaw(skeleton, leader, direction), origin) {}

Standardisation::Standardisation(const Skeleton& skeleton, const Poses& leader, double yaw,
                                 StandardOrigin origin)
    : yaw_(yaw) {
  for (int t = 0; t < leader.frame_count(); ++t) {
    roots_.push_back(leader.at(origin == StandardOrigin::kEveryFrame ? t : 0, skeleton.root));
  }
}

Vec3 Standardisation::Apply(Vec3 world) const { return RotateY(world - roots_.front(), yaw_); }

Poses Standardisation::Apply(const Poses& world, int first_frame) const {
  Poses standard = world;
  for (int t = 0; t < world.frame_count(); ++t) {
    const Vec3 root = roots_[static_cast<size_t>(first_frame + t)];
    for (Vec3& position : standard[t]) position = RotateY(position - root, yaw_);
  }
  return standard;
}

Poses Standardisation::Invert(const Poses& standard, int first_frame) const {
  Poses world = standard;
  for (int t = 0; t < standard.frame_count(); ++t) {
    const Vec3 root = roots_[static_cast<size_t>(first_frame + t)];
    for (Vec3& position : world[t]) position = RotateY(position, -yaw_) + root;
  }
  return world;
}

}  // namespace duet::motion
