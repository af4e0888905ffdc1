#ifndef DUET_MODEL_ENGINE_DIRECTION_ESTIMATE_H_
#define DUET_MODEL_ENGINE_DIRECTION_ESTIMATE_H_

#include <optional>
#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::engine {

// How a leader's motion tells where the partner is: the cosine and the sine of the angle from where
// the hips face in the first frame, each linear in features of the motion as those hips see it.
//
// Shapes: all [DirectionFeatureCount].
// Source: ridge regression over training leaders, model/training/direction_fit.h;
//         docs/decisions/0022-direction-from-the-leader.md.
struct DirectionRegression {
  std::vector<double> mean, deviation;  // of the training features
  std::vector<double> cosine, sine;     // factors of the scaled features
};

// Along and across the hips: every joint's mean place relative to the root, the root's mean and its
// last place relative to its first; and one feature that is always 1.
inline int DirectionFeatureCount(const motion::Skeleton& skeleton) {
  return 2 * (skeleton.joint_count() + 1) + 1;
}

// Metres. Nothing where the hips have no direction: a skeleton without them, or both on one spot.
std::optional<std::vector<double>> DirectionFeatures(const motion::Skeleton& skeleton,
                                                     const motion::Poses& leader);

// In deviations from the training mean, at most 3 either way: no motion may be so strange that it
// alone decides.
std::vector<double> ScaledFeatures(const DirectionRegression& regression,
                                   std::vector<double> features);

// The horizontal direction from the leader to the partner, of length 1. Nothing where the hips have
// no direction. Turns with the leader. `leader`: one frame or more, metres, y up.
std::optional<motion::Vec3> EstimatePartnerDirection(const DirectionRegression& regression,
                                                     const motion::Skeleton& skeleton,
                                                     const motion::Poses& leader);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_DIRECTION_ESTIMATE_H_
