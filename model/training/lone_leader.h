#ifndef DUET_MODEL_TRAINING_LONE_LEADER_H_
#define DUET_MODEL_TRAINING_LONE_LEADER_H_

#include "absl/status/status.h"
#include "model/base/random.h"
#include "model/dataset/dataset.h"
#include "model/engine/model_description.h"
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
// goes back to its first pose (reaction_pace.h). Then it passes the stages of a server, so that
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

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_LONE_LEADER_H_
