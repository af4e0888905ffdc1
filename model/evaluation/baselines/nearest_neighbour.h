#ifndef DUET_MODEL_EVALUATION_BASELINES_NEAREST_NEIGHBOUR_H_
#define DUET_MODEL_EVALUATION_BASELINES_NEAREST_NEIGHBOUR_H_

#include <vector>

#include "model/evaluation/baselines/per_class_method.h"

namespace duet::evaluation::baselines {

// Answers with the follower of the most similar leader of the same class (time-warped distance over
// the whole clip), stretched to the leader's length.
//
// Source: row NN of the paper's Table 1, taken there from Huang et al. 2015. Implementation:
// docs/baselines.md.
class NearestNeighbour : public PerClassMethod {
 public:
  NearestNeighbour() : PerClassMethod("nearest_neighbour") {}

 protected:
  void Reset(int classes) override { pairs_.assign(static_cast<size_t>(classes), {}); }
  void TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) override;
  Rows PredictClass(int interaction_class, const StandardPair& leader) const override;

 private:
  std::vector<std::vector<StandardPair>> pairs_;
};

// The mean distance of matched rows along the best monotone matching of two motions (dynamic time
// warping: steps in either or both; first and last rows are matched). Requires the same number of
// columns and at least one row each.
double TimeWarpedDistance(const Rows& a, const Rows& b);

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_NEAREST_NEIGHBOUR_H_
