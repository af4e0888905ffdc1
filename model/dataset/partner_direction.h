#ifndef DUET_MODEL_DATASET_PARTNER_DIRECTION_H_
#define DUET_MODEL_DATASET_PARTNER_DIRECTION_H_

#include "model/dataset/dataset.h"

namespace duet::dataset {

// The horizontal direction from leader to follower, of any length: that of the capture's setup if
// it defines one, otherwise from root to root in the first frame.
motion::Vec3 PartnerDirection(const motion::Skeleton& skeleton, const Sequence& sequence);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_PARTNER_DIRECTION_H_
