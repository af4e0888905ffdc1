#include "model/body/hands.h"

#include <algorithm>
#include <cstddef>

namespace duet::body {

double ReachTowards(const Limb& arm, int root, absl::Span<const motion::Vec3> pose,
                    motion::Vec3 partner_root) {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  const float length = LengthOf(arm, pose);
  const motion::Vec3 way = {partner_root.x - at(root).x, 0, partner_root.z - at(root).z};
  if (length == 0 || Norm(way) == 0) return 0;
  return double{Dot(at(arm.end) - at(root), way) / (Norm(way) * length)};
}

std::optional<double> OfferedHandDistance(const Body& body, int root,
                                          absl::Span<const motion::Vec3> leader,
                                          absl::Span<const motion::Vec3> follower) {
  std::optional<double> nearest;
  for (const Limb& offered : body.arms) {
    const motion::Vec3 partner = follower[static_cast<std::size_t>(root)];
    if (ReachTowards(offered, root, leader, partner) < kOffersReach) continue;
    for (const Limb& arm : body.arms) {
      const double distance = double{Distance(leader[static_cast<std::size_t>(offered.end)],
                                              follower[static_cast<std::size_t>(arm.end)])};
      nearest = std::min(nearest.value_or(distance), distance);
    }
  }
  return nearest;
}

}  // namespace duet::body
