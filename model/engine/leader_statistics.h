#ifndef DUET_MODEL_ENGINE_LEADER_STATISTICS_H_
#define DUET_MODEL_ENGINE_LEADER_STATISTICS_H_

#include <string>
#include <string_view>
#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// What a leader does, in a handful of numbers that people can read. None of them depends on where
// the leader stands, which way it faces, or which hand it uses.
//
// Units: metres, y up, seconds, degrees.

struct LeaderFeature {
  std::string_view name;
  // Smaller differences are insignificant. In the feature's unit.
  double smallest_deviation = 0;
};

// Returns the features of a skeleton, always in this order:
//   mean_joint_speed     m/s, over all joints and frames
//   highest_joint_speed  m/s, of any joint between any two frames
//   root_path_speed      m/s, length of the root's path along the floor divided by its duration
//   root_travel          m, maximum distance of the root along the floor from its first position
//   still_share          0 to 1, fraction of frames in which the joints hardly move
//   bone_length          m, mean of all bones
//   root_height          root above the lower foot, by the bones between them     (feet)
//   turn                 degrees, maximum turn of the hips from their first direction    (hips)
//   trunk_lean           degrees, angle of hips to neck from vertical             (hips, "neck")
//   hand_reach           m, root to the farther hand       ("left_hand" and "right_hand")
// The mean over the frames unless stated otherwise. Speeds are filtered against measurement noise.
// Parentheses: the joints that the skeleton must have.
std::vector<LeaderFeature> LeaderFeatures(const motion::Skeleton& skeleton);

// Returns the values of LeaderFeatures. Requires at least one frame. A single frame has speed 0.
std::vector<double> MeasureLeader(const motion::Skeleton& skeleton, const motion::Poses& leader,
                                  double frame_rate_hz);

// Mean and standard deviation of each feature of a model's training leaders.
struct LeaderStatistics {
  struct Feature {
    std::string name;  // one of LeaderFeatures
    double mean = 0;
    double deviation = 1;  // above 0
  };
  std::vector<Feature> features;
  // The distance that a tenth of the training leaders exceeds, in deviations: above 0.
  double scale = 1;
};

// Computes the statistics of training leaders, each with at least one frame and no longer than a
// window. Deviations have a minimum (LeaderFeature::smallest_deviation), and so has the scale, so
// that a few similar leaders do not make all others unfamiliar. Requires at least one leader.
LeaderStatistics FitLeaderStatistics(const motion::Skeleton& skeleton,
                                     const std::vector<const motion::Poses*>& leaders,
                                     double frame_rate_hz);

// Returns the distance of a motion, no longer than a window, from the training leaders: the root
// mean square of the features' distances from their means in deviations, divided by the scale. A
// tenth of the training leaders have a distance above 1. Features that the statistics lack are
// ignored.
double Unfamiliarity(const LeaderStatistics& statistics, const motion::Skeleton& skeleton,
                     const motion::Poses& leader, double frame_rate_hz);

// Returns the smallest of the values that at least nine tenths of them do not exceed. Requires a
// value.
double NinthDecile(std::vector<double> values);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_LEADER_STATISTICS_H_
