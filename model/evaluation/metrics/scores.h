#ifndef DUET_MODEL_EVALUATION_METRICS_SCORES_H_
#define DUET_MODEL_EVALUATION_METRICS_SCORES_H_

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/motion/poses.h"

namespace duet::evaluation::metrics {

// The figures of a follower as the tables print them, in this order. The names are
// lower_snake_case, with the unit unless it is the raw one.
inline constexpr const char* kMetrics[] = {
    "afd",                    // Eq. 6, SBU's raw unit
    "afd_squared",            // squared norm, raw unit squared
    "afd_m",                  //
    "afd_squared_m",          // m^2
    "root_aligned_afd",       // raw unit
    "root_aligned_afd_m",     //
    "velocity_error",         // m/s
    "bone_length_drift",      // share of the length
    "jitter",                 // m/s^3
    "skating_ratio",          // share of steps on the floor
    "foot_slide_cm",          // centimetres per frame
    "penetration_frequency",  // share of frames
    "penetration_depth_m",    // mean over those frames
    "joint_speed",            // m/s, without noise
    "range_of_motion_m",      // without noise
    "filtered_jerk",          // m/s^3, jitter without noise
    "lean_degrees",           // hips to neck, mean over frames
    "facing_degrees",         // angle to the leader
    "root_distance_m",        // to the leader's, along the floor
    "touch",                  // share of frames
};

// A follower for a sequence of the data set, synthesised or captured.
struct ScoredMotion {
  int sequence = 0;        // its index in the data set
  motion::Poses follower;  // world metres
};

inline const dataset::Sequence& SequenceOf(const dataset::Dataset& dataset,
                                           const ScoredMotion& motion) {
  return dataset.sequences[static_cast<size_t>(motion.sequence)];
}

// Every metric of one motion, in the order of kMetrics. Those in the raw unit are measured in the
// world as captured, before levelling.
std::vector<double> ScoreMotion(const dataset::Dataset& dataset, const ScoredMotion& motion);

// Figures by the metric's name. Shapes: [classes] each.
using FiguresByMetric = std::map<std::string, std::vector<double>>;

// Every metric's means over the motions of each class; NaN for a class without any. All motions
// have equal weight, except in penetration depth, which is a mean over the motions that penetrate.
FiguresByMetric ScoreByClass(const dataset::Dataset& dataset,
                             const std::vector<ScoredMotion>& motions);

// The classes of sequences of the data set.
std::vector<int> ClassesOf(const dataset::Dataset& dataset, const std::vector<int>& sequences);

// The captured followers of sequences of the data set, in the same order.
std::vector<ScoredMotion> CapturedMotions(const dataset::Dataset& dataset,
                                          const std::vector<int>& sequences);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_SCORES_H_
