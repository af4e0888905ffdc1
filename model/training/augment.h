#ifndef DUET_MODEL_TRAINING_AUGMENT_H_
#define DUET_MODEL_TRAINING_AUGMENT_H_

#include <vector>

#include "model/base/random.h"
#include "model/dataset/dataset.h"
#include "model/training/options.h"

namespace duet::training {

// For each joint, its counterpart in a mirror: left and right exchanged by name.
std::vector<int> MirroredJoints(const motion::Skeleton& skeleton);

// Reflects a person in the plane x = 0 and exchanges its left and right joints.
void Mirror(const std::vector<int>& mirrored_joints, motion::Poses* poses);

// Reflects both people in the plane x = 0 and exchanges their left and right joints.
void Mirror(const std::vector<int>& mirrored_joints, dataset::Sequence* sequence);

// Exchanges leader and follower.
void SwapRoles(dataset::Sequence* sequence);

// Adds the noise of a captured leader: `noise` and `body_noise` of the options.
void DisturbLeader(const TrainingOptions::Augmentation& options, base::Random* random,
                   motion::Clip* leader);

// A random variant of a sequence. Requires options that CheckAgainst accepts.
dataset::Sequence Augment(const dataset::Dataset& dataset, const dataset::Sequence& sequence,
                          const TrainingOptions::Augmentation& options, base::Random* random);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_AUGMENT_H_
