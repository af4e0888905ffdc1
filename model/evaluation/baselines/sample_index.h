#ifndef DUET_MODEL_EVALUATION_BASELINES_SAMPLE_INDEX_H_
#define DUET_MODEL_EVALUATION_BASELINES_SAMPLE_INDEX_H_

#include <Eigen/Core>

#include "model/base/random.h"

namespace duet::evaluation::baselines {

// Draws an index with a probability proportional to its weight. Weights are >= 0 and at least one
// is > 0.
inline Eigen::Index SampleIndex(const Eigen::Ref<const Eigen::VectorXd>& weights,
                                base::Random* random) {
  double left = random->Uniform() * weights.sum();
  Eigen::Index pick = 0;
  while (pick + 1 < weights.size() && left >= weights(pick)) left -= weights(pick++);
  return pick;
}

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_SAMPLE_INDEX_H_
