#include "model/motion/standardise.h"

#include <cmath>

namespace duet::motion {
namespace {

// The yaw to turn by, given the leader's left-to-right hip direction in the first frame.
double HipYaw(Vec3 across, YawDirection direction) {
  // Hips that coincide (a degenerate leader) have no direction: leave the clip unturned.
  if (across.x == 0 && across.z == 0) return 0;
  // The published code takes the arc tangent of the quotient, which does not tell a direction from
  // its opposite, and turns by it the wrong way round.
  if (direction == YawDirection::kAsReleasedCode) return -std::atan(across.z / across.x);
  return std::atan2(across.z, across.x);
}

double HipYaw(const Skeleton& skeleton, const std::vector<Vec3>& leader, YawDirection direction) {
  return HipYaw(leader[static_cast<size_t>(skeleton.right_hip)] -
                    leader[static_cast<size_t>(skeleton.left_hip)],
                direction);
}

}  // namespace

double FacingYaw(Vec3 direction) { return std::atan2(direction.x, -direction.z); }

Standardisation::Standardisation(const Skeleton& skeleton, const std::vector<Vec3>& leader,
                                 YawDirection direction, StandardOrigin origin)
    : Standardisation(skeleton, leader, HipYaw(skeleton, leader, direction), origin) {}

Standardisation::Standardisation(const Skeleton& skeleton, const std::vector<Vec3>& leader,
                                 double yaw, StandardOrigin origin)
    : joints_(skeleton.joint_count()), yaw_(yaw) {
  const size_t joints = static_cast<size_t>(joints_);
  const size_t first = static_cast<size_t>(skeleton.root);
  for (size_t at = first; at < leader.size(); at += joints) {
    roots_.push_back(leader[origin == StandardOrigin::kEveryFrame ? at : first]);
  }
}

Vec3 Standardisation::Apply(Vec3 world) const { return RotateY(world - roots_.front(), yaw_); }

std::vector<Vec3> Standardisation::Apply(const std::vector<Vec3>& world, int first_frame) const {
  const size_t joints = static_cast<size_t>(joints_);
  std::vector<Vec3> standard(world.size());
  for (size_t i = 0; i < world.size(); ++i) {
    standard[i] = RotateY(world[i] - roots_[static_cast<size_t>(first_frame) + i / joints], yaw_);
  }
  return standard;
}

std::vector<Vec3> Standardisation::Invert(const std::vector<Vec3>& standard,
                                          int first_frame) const {
  const size_t joints = static_cast<size_t>(joints_);
  std::vector<Vec3> world(standard.size());
  for (size_t i = 0; i < standard.size(); ++i) {
    world[i] = RotateY(standard[i], -yaw_) + roots_[static_cast<size_t>(first_frame) + i / joints];
  }
  return world;
}

}  // namespace duet::motion
