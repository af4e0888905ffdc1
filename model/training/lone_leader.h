#ifndef DUET_MODEL_TRAINING_LONE_LEADER_H_
#define DUET_MODEL_TRAINING_LONE_LEADER_H_

#include <vector>

#include "absl/status/status.h"
#include "model/base/random.h"
#include "model/dataset/dataset.h"
#include "model/engine/model_description.h"
#include "model/motion/poses.h"
#include "model/training/options.h"

namespace duet::training {

// Checks the leaders without followers of a data set: there are some exactly if the options use
// them, the skeleton has hips, and one of the motions is at least as long as the longest sequence.
// INVALID_ARGUMENT otherwise.
absl::Status CheckLoneLeaders(const TrainingOptions& options, const dataset::Dataset& dataset);

// Gives a captured follower another leader: a random part of one of dataset.lone_leaders. The
// follower moves as captured, but its place and direction are those that it had relative to its
// own leader. If the new leader turns, the follower walks around it, at most as fast as people do,
// so that it is sometimes beside or behind a leader who turns quickly. Beside one who rests, it
// goes back to its first pose. Then it passes the stages of a server, so that
// feet step where the follower is carried along and bodies keep apart. A leader without a follower
// thus has the distribution of captured followers of the class as its target.
//
// The new leader is mirrored in half of the cases if the options mirror any class, and gets the
// noise of a captured one. A sequence that is longer than every such leader does not change.
// Requires a skeleton with hips and at least one such leader. `model` describes the model in
// training.
void ReplaceLeader(const engine::ModelDescription& model, const dataset::Dataset& dataset,
                   const TrainingOptions::Augmentation& options, base::Random* random,
                   dataset::Sequence* sequence);

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

#endif  // DUET_MODEL_TRAINING_LONE_LEADER_H_
