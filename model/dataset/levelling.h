#ifndef DUET_MODEL_DATASET_LEVELLING_H_
#define DUET_MODEL_DATASET_LEVELLING_H_

#include "model/dataset/dataset.h"

namespace duet::dataset {

// Levels captures: a tilted camera captures people who lean. Every set of sequences
// (Sequence::set) gets one motion::Levelling, kept in its sequences.
//
// The vertical is the robust mean (posture.h) of the standing directions of both people in all
// frames of the set, drawn towards that of the whole data set as if 3 more sequences showed it; the
// floor is the height that a quarter of the lower feet are below. The floor's slope is left out
// (docs/decisions/0020-level-captures.md).
//
// Left as they are: data of fewer than 60 standing poses, of a skeleton without feet, or whose
// people lie rather than lean (a set's vertical is more than 30 degrees from +y).
void LevelSets(Dataset* dataset);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_LEVELLING_H_
