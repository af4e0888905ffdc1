#include "model/body/surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/motion/capsules.h"

namespace duet::body {
namespace {

bool IsOfArm(const Body& body, const motion::Bone& bone) {
  return std::any_of(body.arms.begin(), body.arms.end(), [&](const Limb& arm) {
    return bone.parent == arm.upper || bone.parent == arm.middle || bone.parent == arm.end;
  });
}

}  // namespace

Surface::Surface(const motion::Skeleton& skeleton, const Body& body) {
  const std::vector<double> radii = CapsuleRadii(skeleton, body);
  for (std::size_t b = 0; b < radii.size(); ++b) {
    if (!IsOfArm(body, skeleton.bones[b])) bones_.push_back({skeleton.bones[b], radii[b]});
  }
}

double Surface::Distance(motion::Vec3 point, absl::Span<const motion::Vec3> pose) const {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  double nearest = HUGE_VAL;
  for (const Bone& bone : bones_) {
    const double from_axis =
        motion::SegmentDistance(point, point, at(bone.joints.parent), at(bone.joints.child));
    nearest = std::min(nearest, from_axis - bone.radius);
  }
  return nearest;
}

}  // namespace duet::body
