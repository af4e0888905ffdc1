#include "model/evaluation/baselines/class_mean.h"

namespace duet::evaluation::baselines {

void ClassMean::TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) {
  // Each frame counts alike, as in the metric.
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(pairs[0].follower.cols());
  double frames = 0;
  for (const StandardPair& pair : pairs) {
    sum += pair.follower.colwise().sum();
    frames += static_cast<double>(pair.follower.rows());
  }
  means_[static_cast<size_t>(interaction_class)] = sum / frames;
}

Rows ClassMean::PredictClass(int interaction_class, const StandardPair& leader) const {
  return means_[static_cast<size_t>(interaction_class)].replicate(leader.leader.rows(), 1);
}

}  // namespace duet::evaluation::baselines
