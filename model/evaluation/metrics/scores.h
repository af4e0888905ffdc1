#ifndef DUET_MODEL_EVALUATION_METRICS_SCORES_H_
#define DUET_MODEL_EVALUATION_METRICS_SCORES_H_

#include <string>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/motion/poses.h"

namespace duet::evaluation::metrics {

// A figure of a synthesised follower, as the tables print it.
enum class Metric {
  kAfd,                   // afd: Eq. 6, SBU's raw unit
  kAfdSquared,            // afd_squared: squared norm, raw unit squared
  kAfdMetres,             // afd_m
  kAfdSquaredMetres,      // afd_squared_m: m^2
  kRootAlignedAfd,        // root_aligned_afd: raw unit
  kRootAlignedAfdMetres,  // root_aligned_afd_m
  kVelocityError,         // velocity_error: m/s
  kBoneLengthDrift,       // bone_length_drift: share of the length
  kJitter,                // jitter: m/s^3
  kSkatingRatio,          // skating_ratio: share of steps on the floor
  kFootSlide,             // foot_slide_cm: centimetres per frame
  kPenetrationFrequency,  // penetration_frequency: share of frames
  kPenetrationDepth,      // penetration_depth_m: mean over those frames
  kJointSpeed,            // joint_speed: m/s, without noise
  kRangeOfMotion,         // range_of_motion_m: without noise
  kFilteredJerk,          // filtered_jerk: m/s^3, jitter without noise
  kLean,                  // lean_degrees: hips to neck, mean over frames
  kFacing,                // facing_degrees: angle to the leader
  kRootDistance,          // root_distance_m: to the leader's, along the floor
  kTouch,                 // touch: share of frames
};

const std::vector<Metric>& AllMetrics();
// lower_snake_case, with the unit unless it is the raw one.
std::string MetricName(Metric metric);

// A follower for a sequence of the data set, synthesised or captured.
struct ScoredMotion {
  int sequence = 0;        // its index in the data set
  motion::Poses follower;  // world metres
};

// Every metric of one motion, in the order of AllMetrics. Those in the raw unit are measured in the
// world as captured, before levelling.
std::vector<double> ScoreMotion(const dataset::Dataset& dataset, const ScoredMotion& motion);

// Means over the motions of each class, in the order of AllMetrics; NaN for a class without any.
// All motions have equal weight, except in penetration depth, which is a mean over the motions that
// penetrate. Shapes: returns [classes][metrics].
std::vector<std::vector<double>> ScoreByClass(const dataset::Dataset& dataset,
                                              const std::vector<ScoredMotion>& motions);

// The captured followers of sequences of the data set, in the same order.
std::vector<ScoredMotion> CapturedMotions(const dataset::Dataset& dataset,
                                          const std::vector<int>& sequences);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_SCORES_H_
