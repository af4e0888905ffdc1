#ifndef DUET_MODEL_TRAINING_REACTION_PACE_H_
#define DUET_MODEL_TRAINING_REACTION_PACE_H_

#include <vector>

#include "model/base/random.h"
#include "model/motion/poses.h"

namespace duet::training {

// How much a leader acts in every frame, by the speed of its joints: from 0, it rests, to 1.
std::vector<double> ActingShares(const motion::Poses& leader, double frame_rate_hz);

// The frames of a captured reaction that a follower goes through beside another leader, in frames
// of the reaction, for `frames` frames of that leader from `first` on.
//
// While the leader acts, the reaction advances at its own pace, and goes back after its end. While
// the leader rests, the follower goes back to its first pose, and sways there. Captures end with
// the reaction; without the way back, each window of a long clip would begin where the last
// reaction ended, and turn further away. Half of the followers begin in the midst of the reaction.
std::vector<double> ReactionFrames(const std::vector<double>& acting_shares, int first, int frames,
                                   double frame_rate_hz, base::Random* random);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_REACTION_PACE_H_
