#include "model/cleanup/girdle.h"

#include <cstddef>

#include "model/cleanup/directions.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

}  // namespace

Girdle GirdleOf(const body::Body& body, const std::optional<motion::JointPair>& joints,
                absl::Span<const Vec3> pose, const Girdle& before) {
  if (!joints || !body.chest || body.legs.size() != 2) return before;
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  const Vec3 hips = Lerp(at(body.legs[0].upper), at(body.legs[1].upper), 0.5f);
  const Vec3 up = at(*body.chest) - hips;
  const Vec3 front = Cross(at(joints->left) - at(joints->right), up);
  const float height = Norm(up), area = Norm(front);
  if (height <= kNoDirection || area <= kNoDirection * height) return before;
  Girdle girdle;
  girdle.up = up / height;
  girdle.front = front / area;
  girdle.left = Cross(girdle.up, girdle.front);
  return girdle;
}

Girdles GirdlesOf(const body::Body& body, const std::optional<motion::JointPair>& joints,
                  const motion::Poses& poses) {
  Girdles girdles(static_cast<std::size_t>(poses.frame_count()));
  Girdle girdle;
  for (int t = 0; t < poses.frame_count(); ++t) {
    girdle = GirdleOf(body, joints, poses[t], girdle);
    girdles[static_cast<std::size_t>(t)] = girdle;
  }
  return girdles;
}

}  // namespace duet::cleanup
