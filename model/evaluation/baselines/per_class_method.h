#ifndef DUET_MODEL_EVALUATION_BASELINES_PER_CLASS_METHOD_H_
#define DUET_MODEL_EVALUATION_BASELINES_PER_CLASS_METHOD_H_

#include <string>
#include <utility>
#include <vector>

#include "model/evaluation/baselines/motion_matrix.h"
#include "model/evaluation/protocol/method.h"

namespace duet::evaluation::baselines {

// A method that learns one model for each interaction class, in the standard coordinates.
// Subclasses implement TrainClass and PredictClass.
class PerClassMethod : public protocol::Method {
 public:
  explicit PerClassMethod(std::string name) : name_(std::move(name)) {}

  std::string name() const override { return name_; }

  // Errors: INVALID_ARGUMENT when a class of the data set has no training sequence.
  absl::Status Train(const dataset::Dataset& dataset, const std::vector<int>& train) override;
  absl::StatusOr<motion::Poses> Predict(const dataset::Sequence& sequence) const override;

 protected:
  // Discards the results of an earlier Train.
  virtual void Reset(int classes) = 0;
  // `pairs` holds at least one sequence.
  virtual void TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) = 0;
  // The follower of a leader (pair.follower is empty). Shapes: returns [frames, 3 joints].
  virtual Rows PredictClass(int interaction_class, const StandardPair& leader) const = 0;

 private:
  std::string name_;
  motion::Skeleton skeleton_;
};

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_PER_CLASS_METHOD_H_
