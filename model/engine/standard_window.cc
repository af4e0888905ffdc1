#include "model/engine/standard_window.h"

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

NetworkInput Standardise(const motion::Standardisation& standardisation,
                         const SynthesisWindow& window) {
  NetworkInput input;
  input.leader = standardisation.Apply(window.leader);
  input.hidden_frames = window.hidden_frames;
  input.labels = window.labels;
  input.sampling = window.options.sampling;
  input.settled = standardisation.Apply(window.settled);
  input.cancelled = window.cancelled.get();
  if (!window.start) return input;
  input.start = FollowerStart{standardisation.Apply(window.start->root), {}};
  for (const motion::Vec3& joint : window.start->pose) {
    input.start->pose.push_back(standardisation.Apply(joint));
  }
  return input;
}

}  // namespace duet::engine
