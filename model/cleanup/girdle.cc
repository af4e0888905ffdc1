#include "model/cleanup/girdle.h"

#include <cstddef>

namespace duet::cleanup {
namespace {

using motion::Vec3;

// Metres. A shorter vector has no direction.
constexpr float kNoDirection = 1e-4f;

}  // namespace

Girdles GirdlesOf(const body::Body& body, const std::optional<motion::JointPair>& joints,
                  const motion::Poses& poses) {
  Girdles girdles(static_cast<std::size_t>(poses.frame_count()));
  if (!joints || !body.chest || body.legs.size() != 2) return girdles;
  Girdle girdle;
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3 hips = Lerp(poses.at(t, body.legs[0].upper), poses.at(t, body.legs[1].upper), 0.5f);
    const Vec3 up = poses.at(t, *body.chest) - hips;
    const Vec3 front = Cross(poses.at(t, joints->left) - poses.at(t, joints->right), up);
    const float height = Norm(up), area = Norm(front);
    // A trunk without directions keeps those of the frame before.
    if (height > kNoDirection && area > kNoDirection * height) {
      girdle.up = up / height;
      girdle.front = front / area;
      girdle.left = Cross(girdle.up, girdle.front);
    }
    girdles[static_cast<std::size_t>(t)] = girdle;
  }
  return girdles;
}

}  // namespace duet::cleanup
