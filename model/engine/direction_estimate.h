#ifndef DUET_MODEL_ENGINE_DIRECTION_ESTIMATE_H_
#define DUET_MODEL_ENGINE_DIRECTION_ESTIMATE_H_

#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::engine {

// The cosine and sine of an angle, each linear in features of the leader's motion.
//
// Shapes: all [DirectionFeatureCount].
struct AngleRegression {
  std::vector<double> mean, deviation;  // of the training features
  std::vector<double> cosine, sine;     // coefficients of the scaled features
};

// What one class adds to the coefficients, for each unit of its weight.
struct ClassCoefficients {
  std::vector<double> cosine, sine;  // [DirectionFeatureCount]
};

// Corrects an estimate by the same motion as it looks from the estimated direction.
struct DirectionCorrection : AngleRegression {
  std::vector<ClassCoefficients> classes;  // [classes]
};

// Estimates the direction of the partner from the leader's motion: first the angle from the
// direction of the hips in the first frame, by features relative to those hips; then corrections of
// the estimate, by features relative to it.
//
// Source: ridge regression over training leaders, model/training/direction_fit.h;
//         docs/decisions/method.md.
struct DirectionRegression : AngleRegression {
  // Absent: the first estimate is the result, as in checkpoints before version 1.1 of Duet.
  std::optional<DirectionCorrection> correction;
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
std::vector<double> ScaledFeatures(const AngleRegression& regression, std::vector<double> features);

// Returns the features relative to a direction at `angle` instead of the hips' direction.
std::vector<double> TurnedFeatures(std::vector<double> features, double angle);

// Returns how much each class asks to be taken into account: the mean over the frames of its
// weights above 0, divided by their sum if that is above 1. `labels`: [frames, classes].
std::vector<double> ClassShares(absl::Span<const float> labels, int classes);

// Returns the horizontal direction from the leader to the partner, of length 1. Absent if the hips
// have no direction. Rotating the leader rotates the result. `leader`: at least one frame, metres,
// y up. `labels`: [frames, classes]; empty: no class is known.
std::optional<motion::Vec3> EstimatePartnerDirection(const DirectionRegression& regression,
                                                     const motion::Skeleton& skeleton,
                                                     const motion::Poses& leader,
                                                     absl::Span<const float> labels = {});

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_DIRECTION_ESTIMATE_H_
