#ifndef DUET_MODEL_TRAINING_OTHER_LEAD_H_
#define DUET_MODEL_TRAINING_OTHER_LEAD_H_

#include <vector>

#include "model/base/random.h"
#include "model/dataset/dataset.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// Leads that do not ask for what the labels say. A lead of a dance shows what it wants, so that a
// network that only sees captured pairs ignores their labels. World metres, y up.
namespace duet::training {

// `own` up to frame `last`, then `other` from the same frame on: turned about the vertical and
// moved along the floor so that the hips of both coincide in frame `last`, and joined to it within
// `join_frames`. Requires frames 0 to `last` in both, and `other` not shorter than `own`.
motion::Poses ContinuedBy(const motion::Skeleton& skeleton, const motion::Poses& own, int last,
                          const motion::Poses& other, int join_frames);

// Draws a sequence whose time line shares no class with that of `own` in the frames after `last`,
// and which is not shorter. Null if none of a few draws is one, or without time lines.
const dataset::Sequence* DrawOther(const std::vector<dataset::Sequence>& sequences,
                                   const dataset::Sequence& own, int last, base::Random* random);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_OTHER_LEAD_H_
