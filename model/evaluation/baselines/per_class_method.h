#ifndef DUET_MODEL_EVALUATION_BASELINES_PER_CLASS_METHOD_H_
#define DUET_MODEL_EVALUATION_BASELINES_PER_CLASS_METHOD_H_

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/evaluation/baselines/motion_matrix.h"
#include "model/evaluation/protocol/method.h"

namespace duet::evaluation::baselines {

// A model of one interaction class, in the standard coordinates.
class ClassModel {
 public:
  virtual ~ClassModel() = default;
  // The follower of a leader (leader.follower is empty). Shapes: returns [frames, 3 joints].
  virtual Rows Predict(const StandardPair& leader) const = 0;
};

// A method that learns one model for each interaction class.
class PerClassMethod : public protocol::Method {
 public:
  // Learns a class from its pairs, of which there is at least one.
  using Learn = std::unique_ptr<ClassModel> (*)(const std::vector<StandardPair>& pairs);

  PerClassMethod(std::string name, Learn learn) : name_(std::move(name)), learn_(learn) {}

  std::string name() const override { return name_; }
  // Discards the results of an earlier call. Errors: INVALID_ARGUMENT when a class of the data set
  // has no training sequence.
  absl::Status Train(const dataset::Dataset& dataset, const std::vector<int>& train) override;
  absl::StatusOr<motion::Poses> Predict(const dataset::Sequence& sequence) const override;

 private:
  std::string name_;
  Learn learn_;
  motion::Skeleton skeleton_;
  std::vector<std::unique_ptr<ClassModel>> models_;  // [classes]
};

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_PER_CLASS_METHOD_H_
