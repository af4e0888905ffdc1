#ifndef DUET_MODEL_DATASET_LEVELLING_H_
#define DUET_MODEL_DATASET_LEVELLING_H_

#include "model/dataset/dataset.h"

namespace duet::dataset {

// Levels captures of a tilted camera, in which people lean. All sequences of a set (Sequence::set)
// share one motion::Levelling, which each of them stores.
//
// The vertical is the robust mean (posture.h) of the standing directions of both people in all
// frames of the set. It is shrunk towards that of the whole data set, with the weight of 3
// sequences. The floor is the lower quartile of the heights of the lower feet. The floor's slope is
// not used (docs/decisions/captures.md).
//
// Unchanged: data with fewer than 60 standing poses, with a skeleton without feet, or with people
// who lie rather than lean (a set's vertical is more than 30 degrees from +y).
void LevelSets(Dataset* dataset);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_LEVELLING_H_
