#include "model/engine/window_standardisation.h"

#include <cmath>

namespace duet::engine {
namespace {

// Closer than this the direction from root to root says little: people in a hug.
constexpr float kMinDistanceMetres = 0.3f;

}  // namespace

motion::Standardisation WindowStandardisation(const motion::Skeleton& skeleton,
                                              const SynthesisWindow& window,
                                              motion::StandardOrigin origin) {
  if (window.partner_direction) {
    return {skeleton, window.leader, FacingYaw(*window.partner_direction), origin};
  }
  if (window.start) {
    const motion::Vec3 root = window.leader.at(0, skeleton.root);
    const motion::Vec3 toward = window.start->root - root;
    if (std::hypot(toward.x, toward.z) >= kMinDistanceMetres) {
      return {skeleton, window.leader, FacingYaw(toward), origin};
    }
  }
  return {skeleton, window.leader, motion::YawDirection::kRemove, origin};
}

}  // namespace duet::engine
