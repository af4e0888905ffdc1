#include "model/evaluation/baselines/per_class_method.h"

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace duet::evaluation::baselines {

absl::Status PerClassMethod::Train(const dataset::Dataset& dataset, const std::vector<int>& train) {
  skeleton_ = dataset.skeleton;
  std::vector<std::vector<StandardPair>> by_class(dataset.classes.size());
  for (const int i : train) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(i)];
    by_class[static_cast<size_t>(sequence.interaction_class)].push_back(
        StandardiseSequence(skeleton_, sequence));
  }
  Reset(dataset.class_count());
  for (size_t i = 0; i < by_class.size(); ++i) {
    if (by_class[i].empty()) {
      return absl::InvalidArgumentError(absl::StrCat(name(), ": no training sequence of class ",
                                                     dataset.classes[i], ", wanted at least one"));
    }
    TrainClass(static_cast<int>(i), by_class[i]);
  }
  return absl::OkStatus();
}

absl::StatusOr<motion::Poses> PerClassMethod::Predict(const dataset::Sequence& sequence) const {
  const StandardPair leader = StandardLeader(skeleton_, sequence);
  return FollowerToWorld(skeleton_, sequence, PredictClass(sequence.interaction_class, leader));
}

}  // namespace duet::evaluation::baselines
