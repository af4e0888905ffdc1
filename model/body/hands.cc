#include "model/body/hands.h"

#include <cstddef>

namespace duet::body {

double ReachTowards(const Limb& arm, int root, absl::Span<const motion::Vec3> pose,
                    motion::Vec3 partner_root) {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  const float length =
      Distance(at(arm.upper), at(arm.middle)) + Distance(at(arm.middle), at(arm.end));
  const motion::Vec3 way = {partner_root.x - at(root).x, 0, partner_root.z - at(root).z};
  if (length == 0 || Norm(way) == 0) return 0;
  return double{Dot(at(arm.end) - at(root), way) / (Norm(way) * length)};
}

}  // namespace duet::body
