#include "model/evaluation/baselines/class_models.h"

namespace duet::evaluation::baselines {
namespace {

class ClassMean : public ClassModel {
 public:
  explicit ClassMean(const std::vector<StandardPair>& pairs) {
    // Each frame has the same weight, as in the metric.
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(pairs[0].follower.cols());
    double frames = 0;
    for (const StandardPair& pair : pairs) {
      sum += pair.follower.colwise().sum();
      frames += static_cast<double>(pair.follower.rows());
    }
    mean_ = sum / frames;
  }

  Rows Predict(const StandardPair& leader) const override {
    return mean_.replicate(leader.leader.rows(), 1);
  }

 private:
  Eigen::RowVectorXd mean_;
};

}  // namespace

std::unique_ptr<ClassModel> LearnClassMean(const std::vector<StandardPair>& pairs) {
  return std::make_unique<ClassMean>(pairs);
}

}  // namespace duet::evaluation::baselines
