#ifndef DUET_MODEL_EVALUATION_BASELINES_CLASS_MODELS_H_
#define DUET_MODEL_EVALUATION_BASELINES_CLASS_MODELS_H_

#include <memory>
#include <vector>

#include "model/evaluation/baselines/motion_matrix.h"

namespace duet::evaluation::baselines {

// A model of one interaction class, in the standard coordinates.
class ClassModel {
 public:
  virtual ~ClassModel() = default;
  // The follower of a leader (leader.follower is empty). Shapes: returns [frames, 3 joints].
  virtual Rows Predict(const StandardPair& leader) const = 0;
};

// The baselines that learn a model of each class, with the published settings as constants.
// docs/baselines.md has their sources and implementations. `pairs` holds at least one sequence.
std::unique_ptr<ClassModel> LearnClassMean(const std::vector<StandardPair>& pairs);
std::unique_ptr<ClassModel> LearnNearestNeighbour(const std::vector<StandardPair>& pairs);
std::unique_ptr<ClassModel> LearnHmm(const std::vector<StandardPair>& pairs);
// KZBH12: a discrete Markov decision process.
std::unique_ptr<ClassModel> LearnDiscreteMdp(const std::vector<StandardPair>& pairs);
// HK14: kernel-based reinforcement learning.
std::unique_ptr<ClassModel> LearnKernelRl(const std::vector<StandardPair>& pairs);
// HFKB15: approximate maximum-entropy inverse optimal control.
std::unique_ptr<ClassModel> LearnMaxEntIoc(const std::vector<StandardPair>& pairs);

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_CLASS_MODELS_H_
