#include "model/cleanup/trunk_bend.h"

#include <cstddef>
#include <vector>

namespace duet::cleanup {

using motion::Vec3;

void BendAtHips(const motion::Skeleton& skeleton, const body::Body& body, Vec3 axis, float radians,
                absl::Span<Vec3> pose) {
  const auto at = [&](int joint) -> Vec3& { return pose[static_cast<std::size_t>(joint)]; };
  const Vec3 pivot = Lerp(at(skeleton.hips->left), at(skeleton.hips->right), 0.5f);
  const std::vector<Vec3> before(pose.begin(), pose.end());
  for (Vec3& joint : pose) joint = pivot + RotateAbout(joint - pivot, axis, radians);
  const Vec3 forward = body::Facing(*skeleton.hips, pose);
  for (const body::Limb& leg : body.legs) {
    const auto was = [&](int joint) { return before[static_cast<std::size_t>(joint)]; };
    const Vec3 moved = at(leg.upper) - was(leg.upper);
    at(leg.middle) = was(leg.middle) + moved;
    at(leg.end) = was(leg.end) + moved;
    for (const int joint : leg.beyond) at(joint) = was(joint) + moved;
    Reach(leg, was(leg.end), forward, pose);
  }
}

}  // namespace duet::cleanup
