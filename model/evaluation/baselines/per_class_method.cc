#include "model/evaluation/baselines/per_class_method.h"

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace duet::evaluation::baselines {

absl::Status PerClassMethod::Train(const dataset::Dataset& dataset, const std::vector<int>& train) {
  skeleton_ = dataset.skeleton;
  models_.clear();
  std::vector<std::vector<StandardPair>> by_class(dataset.classes.size());
  for (const int i : train) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(i)];
    by_class[static_cast<size_t>(sequence.interaction_class)].push_back(
        StandardiseSequence(skeleton_, sequence));
  }
  for (size_t i = 0; i < by_class.size(); ++i) {
    if (by_class[i].empty()) {
      return absl::InvalidArgumentError(absl::StrCat(
          name(), ": expected a training sequence of class ", dataset.classes[i], ", got none"));
    }
    models_.push_back(learn_(by_class[i]));
  }
  return absl::OkStatus();
}

absl::StatusOr<motion::Poses> PerClassMethod::Predict(const dataset::Sequence& sequence) const {
  const ClassModel& model = *models_[static_cast<size_t>(sequence.interaction_class)];
  return FollowerToWorld(skeleton_, sequence, model.Predict(StandardLeader(skeleton_, sequence)));
}

}  // namespace duet::evaluation::baselines
