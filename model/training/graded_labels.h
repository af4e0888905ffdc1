#ifndef DUET_MODEL_TRAINING_GRADED_LABELS_H_
#define DUET_MODEL_TRAINING_GRADED_LABELS_H_

#include <vector>

#include "model/training/augment.h"
#include "model/training/example.h"

namespace duet::training {

// Gives an example a graded, negative or mixed label vector and the matching target. The paper
// trains on single classes and uses other weights only at inference, where their effect is
// undefined. Here a weight moves the target along the line from standing still (weight 0) through
// the captured reaction (1):
//
//   30 %  own class at w in [0, 1.5]:            still + w (captured - still)
//   15 %  own class at -w in [-1, 0]:            still + w (other - still)
//   10 %  own class at 1, another below 0:       captured
//   45 %  own class at p, another at q, shares:  (1 - p' - q') still + p' captured + q' other
//
// "other" is the follower of a random clip of another class, resampled to this clip's length and
// moved to its place; with a start pose, it begins there. If `pool` (the epoch's sequences) has no
// other class, the example does not change.
void GradeLabels(const dataset::Dataset& dataset, const std::vector<dataset::Sequence>& pool,
                 base::Random* random, Example* example);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_GRADED_LABELS_H_
