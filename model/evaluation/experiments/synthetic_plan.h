#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_PLAN_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_PLAN_H_

#include <cstdint>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/evaluation/experiments/synthetic_job.h"

namespace duet::evaluation::experiments {

struct SyntheticPlanOptions {
  int match = 25;  // motions per class by interaction match
  int mix = 25;    // motions per class by interaction mix
  uint64_t seed = 0;
};

// The jobs for synthetic followers of every class; only the seed determines the draw.
//
// Leaders are those of `train`, those of each class in turn as often as needed, with variations:
// both people exchanged in half of the clips of symmetric classes, bodies larger or smaller by up
// to 8 %, turned by about 6 degrees, played up to 10 % faster or slower. Interaction match gives
// the leader's class a weight of 0.75 to 1.25. Interaction mix gives it 0.75 to 1, and one other
// class 0.1 to 0.35, so that the motion stays one of its class.
//
// Source: paper section 4 (300 synthetic motions, 50 a class, "25 + 25"), which does not say how it
//         varies leaders and weights; read as 25 by interaction match and 25 by interaction mix.
// Shapes: returns match + mix jobs per class, sorted by class; ids "<class>-<place in the set>".
// Requires a sequence of every class in `train`; mix above 0 requires two classes.
std::vector<SyntheticJob> PlanSyntheticSet(const dataset::Dataset& dataset,
                                           const std::vector<int>& train,
                                           const SyntheticPlanOptions& options);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_PLAN_H_
