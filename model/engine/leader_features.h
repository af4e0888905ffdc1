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
  // Leaders that differ by less are alike, in the feature's unit.
  double smallest_deviation = 0;
};

// The features that a skeleton gives, always in this order:
//   mean_joint_speed     m/s, over all joints and frames
//   highest_joint_speed  m/s, of any joint between any two frames
//   root_path_speed      m/s, the root's path along the floor by the time it takes
//   root_travel          m, the farthest that the root gets along the floor from its first place
//   still_share          0 to 1, of the frames in which the joints hardly move
//   bone_length          m, mean of all bones
//   root_height          root above the lower foot, by the bones between them     (feet)
//   turn                 degrees, the farthest that the hips turn from their first direction (hips)
//   trunk_lean           degrees, hips to neck against straight up                (hips, "neck")
//   hand_reach           m, root to the farther hand       ("left_hand" and "right_hand")
// Means over the frames where nothing else is said; speeds without measuring noise.
std::vector<LeaderFeature> LeaderFeatures(const motion::Skeleton& skeleton);

// Their values. Requires a frame; one alone stands still.
std::vector<double> MeasureLeader(const motion::Skeleton& skeleton, const motion::Poses& leader,
                                  double frame_rate_hz);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_LEADER_FEATURES_H_
