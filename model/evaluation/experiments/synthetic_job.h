#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_JOB_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_JOB_H_

#include <vector>

#include "model/dataset/dataset.h"

namespace duet::evaluation::experiments {

// A request for a synthetic motion.
struct SyntheticJob {
  dataset::Sequence sequence;  // a leader of its class; the follower has no positions
  std::vector<float> labels;   // [classes], the label vector
};

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_JOB_H_
