#ifndef DUET_MODEL_EVALUATION_BASELINES_CLASS_MEAN_H_
#define DUET_MODEL_EVALUATION_BASELINES_CLASS_MEAN_H_

#include <vector>

#include "model/evaluation/baselines/per_class_method.h"

namespace duet::evaluation::baselines {

// The trivial method: the mean follower pose of the class, held still in the standard coordinates.
class ClassMean : public PerClassMethod {
 public:
  ClassMean() : PerClassMethod("class_mean") {}

 protected:
  void Reset(int classes) override { means_.assign(static_cast<size_t>(classes), {}); }
  void TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) override;
  Rows PredictClass(int interaction_class, const StandardPair& leader) const override;

 private:
  std::vector<Eigen::RowVectorXd> means_;
};

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_CLASS_MEAN_H_
