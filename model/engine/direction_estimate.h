#ifndef DUET_MODEL_ENGINE_DIRECTION_ESTIMATE_H_
#define DUET_MODEL_ENGINE_DIRECTION_ESTIMATE_H_

#include <optional>
#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::engine {

// Estimates the direction of the partner from the leader's motion: cosine and sine of the angle
// from the direction of the hips in the first frame, each linear in features of the motion relative
// to those hips.
//
// Shapes: all [DirectionFeatureCount].
// Source: ridge regression over training leaders, model/training/direction_fit.h;
//         docs/decisions/0022-direction-from-the-leader.md.
struct DirectionRegression {
  std::vector<double> mean, deviation;  // of the training features
  std::vector<double> cosine, sine;     // coefficients of the scaled features
};

// Along and across the hips: the mean position of every joint relative to the root, the root's mean
// and last positions relative to its first; and one feature that is always 1.
inline int DirectionFeatureCount(const motion::Skeleton& skeleton) {
  return 2 * (skeleton.joint_count() + 1) + 1;
}

// Returns the features in metres. Absent if the hips have no direction: the skeleton has no hips,
// or both are at the same position.
std::optional<std::vector<double>> DirectionFeatures(const motion::Skeleton& skeleton,
                                                     const motion::Poses& leader);

// Returns the features in deviations from the training mean, clamped to [-3, 3], so that no single
// feature dominates.
std::vector<double> ScaledFeatures(const DirectionRegression& regression,
                                   std::vector<double> features);

// Returns the horizontal direction from the leader to the partner, of length 1. Absent if the hips
// have no direction. Rotating the leader rotates the result. `leader`: at least one frame, metres,
// y up.
std::optional<motion::Vec3> EstimatePartnerDirection(const DirectionRegression& regression,
                                                     const motion::Skeleton& skeleton,
                                                     const motion::Poses& leader);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_DIRECTION_ESTIMATE_H_
