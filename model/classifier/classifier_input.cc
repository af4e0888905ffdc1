#include "model/classifier/classifier_input.h"

#include <algorithm>
#include <cmath>

#include "model/motion/standardise.h"

namespace duet::classifier {
namespace {

using motion::StandardOrigin;

// At smaller distances, as in a hug, the direction from root to root is unreliable.
constexpr float kMinDistanceMetres = 0.3f;

motion::Standardisation Standard(const motion::Skeleton& skeleton, const motion::Poses& leader,
                                 const std::optional<motion::Vec3>& partner_direction,
                                 StandardOrigin origin) {
  if (partner_direction) return {skeleton, leader, FacingYaw(*partner_direction), origin};
  return {skeleton, leader, motion::YawDirection::kRemove, origin};
}

// Writes the positions relative to the root, from column `first` on.
void PutAboutRoot(const motion::Poses& poses, int root, int first, motion::Poses* input) {
  for (int t = 0; t < poses.frame_count(); ++t) {
    for (int j = 0; j < poses.joint_count(); ++j) {
      input->at(t, first + j) = poses.at(t, j) - poses.at(t, root);
    }
  }
}

// Writes central differences, one-sided at the ends, times the rate.
void PutVelocity(const motion::Poses& poses, double rate, int first, motion::Poses* input) {
  const int frames = poses.frame_count();
  for (int t = 0; t < frames; ++t) {
    const int before = std::max(t - 1, 0), after = std::min(t + 1, frames - 1);
    const float a_second =
        after == before ? 0 : static_cast<float>(rate) / static_cast<float>(after - before);
    for (int j = 0; j < poses.joint_count(); ++j) {
      input->at(t, first + j) = (poses.at(after, j) - poses.at(before, j)) * a_second;
    }
  }
}

}  // namespace

motion::Poses ClassifierInput(const motion::Skeleton& skeleton, const motion::ClipPair& pair,
                              const std::optional<motion::Vec3>& partner_direction, Sees sees) {
  const motion::Poses& follower = pair.follower.poses;
  const motion::Poses& leader = pair.leader.poses;
  const double rate = pair.follower.frame_rate_hz;
  const auto every_frame =
      Standard(skeleton, leader, partner_direction, StandardOrigin::kEveryFrame);
  const auto first_frame =
      Standard(skeleton, leader, partner_direction, StandardOrigin::kFirstFrame);
  const motion::Poses from_leader = every_frame.Apply(follower);
  const int frames = from_leader.frame_count(), joints = skeleton.joint_count();
  motion::Poses input(frames, InputParts(sees) * joints);
  for (int t = 0; t < frames; ++t) {
    std::copy(from_leader[t].begin(), from_leader[t].end(), input[t].begin());
  }
  PutAboutRoot(from_leader, skeleton.root, joints, &input);
  PutVelocity(first_frame.Apply(follower), rate, 2 * joints, &input);
  if (sees == Sees::kFollower) return input;
  const motion::Poses leads = first_frame.Apply(leader);
  PutAboutRoot(leads, skeleton.root, 3 * joints, &input);
  PutVelocity(leads, rate, 4 * joints, &input);
  return input;
}

std::optional<motion::Vec3> DirectionToFollower(const motion::Skeleton& skeleton,
                                                const motion::ClipPair& pair) {
  motion::Vec3 toward = pair.follower.at(0, skeleton.root) - pair.leader.at(0, skeleton.root);
  if (std::hypot(toward.x, toward.z) < kMinDistanceMetres) return std::nullopt;
  toward.y = 0;
  return toward;
}

}  // namespace duet::classifier
