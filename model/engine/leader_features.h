#ifndef DUET_MODEL_ENGINE_LEADER_FEATURES_H_
#define DUET_MODEL_ENGINE_LEADER_FEATURES_H_

#include <string_view>
#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// What a leader does, in a handful of numbers that people can read. None of them depends on where
// the leader stands, which way it faces, or which hand it uses.
//
// Units: metres, y up, seconds, degrees.

namespace duet::engine {

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

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_LEADER_FEATURES_H_
