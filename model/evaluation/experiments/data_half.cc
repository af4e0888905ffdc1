#include "model/evaluation/experiments/data_half.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/evaluation/experiments/classifier_accuracy.h"

namespace duet::evaluation::experiments {
namespace {

// A row of the tables: the training data of a classifier and its epochs.
struct Condition {
  std::string row;
  TrainingMaterial material;
  int64_t epochs;
};

// The epochs in which `motions` take as many steps as `captured` ones in `epochs`.
int64_t SameSteps(int64_t epochs, size_t captured, size_t motions) {
  const double share = static_cast<double>(captured) / static_cast<double>(motions);
  return std::max<int64_t>(1, std::llround(static_cast<double>(epochs) * share));
}

std::vector<Condition> Conditions(const DataHalf& half, const HalfOptions& options) {
  const std::vector<int>& captured = half.split.train;
  const size_t own = captured.size(), made = half.synthetic.size(), served = half.served.size();
  const int64_t epochs = options.epochs;
  const std::string& both = options.synthetic_row;
  std::vector<Condition> conditions = {
      {kCapturedRow, {captured, {}}, epochs},
      {both, {captured, half.synthetic}, SameSteps(epochs, own, own + made)},
      {absl::StrCat(kCapturedRow, kLonger), {captured, {}}, SameSteps(epochs, own + made, own)},
      {absl::StrCat(both, kLonger), {captured, half.synthetic}, epochs},
      {kSyntheticAloneRow, {{}, half.synthetic}, SameSteps(epochs, own, made)}};
  if (served > 0) {
    conditions.push_back(
        {kServedRow, {captured, half.served}, SameSteps(epochs, own, own + served)});
  }
  return conditions;
}

}  // namespace

absl::Status AddServedSets(const std::vector<SyntheticSet>& sets, std::vector<DataHalf>* halves) {
  for (const SyntheticSet& set : sets) {
    bool used = false;
    for (DataHalf& half : *halves) {
      if (half.seed != set.half) continue;
      half.served = set.sequences;
      used = true;
    }
    if (!used) {
      return absl::InvalidArgumentError(
          absl::StrCat("half of a synthetic set: expected one of the seeds, got ", set.half));
    }
  }
  return absl::OkStatus();
}

absl::Status RunHalf(const dataset::Dataset& dataset, const DataHalf& half,
                     const HalfOptions& options, std::ostream* progress, Trials* trials) {
  for (int repeat = 1; repeat <= options.repeats; ++repeat) {
    for (const Condition& condition : Conditions(half, options)) {
      judge::MotionClassifierOptions classifier;
      classifier.epochs = condition.epochs;
      classifier.seed = static_cast<uint64_t>(repeat);
      absl::StatusOr<std::vector<double>> accuracy =
          ClassifierAccuracy(dataset, condition.material, half.split.test, classifier);
      if (!accuracy.ok()) return accuracy.status();
      *progress << "half " << half.seed << ", classifier " << repeat << ", " << condition.row
                << ": " << accuracy->back() << std::endl;
      trials->Add(condition.row, absl::StrCat(half.seed, "/", repeat), *std::move(accuracy));
    }
  }
  return absl::OkStatus();
}

}  // namespace duet::evaluation::experiments
