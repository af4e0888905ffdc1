#ifndef DUET_MODEL_EVALUATION_BASELINES_HMM_H_
#define DUET_MODEL_EVALUATION_BASELINES_HMM_H_

#include <vector>

#include "model/evaluation/baselines/gaussian_hmm.h"
#include "model/evaluation/baselines/per_class_method.h"
#include "model/evaluation/baselines/pose_space.h"

namespace duet::evaluation::baselines {

struct HmmOptions {
  int leader_components = 4;
  int follower_components = 8;
  GaussianHmmOptions hmm;
};

// One hidden Markov model per class over leader and follower together; the answer is the expected
// follower given the whole leader.
//
// Source: row HMM of the paper's Table 1. Implementation: docs/baselines.md.
class Hmm : public PerClassMethod {
 public:
  explicit Hmm(const HmmOptions& options = {}) : PerClassMethod("hmm"), options_(options) {}

 protected:
  void Reset(int classes) override { models_.assign(static_cast<size_t>(classes), {}); }
  void TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) override;
  Rows PredictClass(int interaction_class, const StandardPair& leader) const override;

 private:
  struct Model {
    PoseSpace leader;
    PoseSpace follower;
    GaussianHmm hmm;
  };

  HmmOptions options_;
  std::vector<Model> models_;
};

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_HMM_H_
