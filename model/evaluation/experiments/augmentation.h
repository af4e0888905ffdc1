#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_AUGMENTATION_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_AUGMENTATION_H_

#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/experiments/synthetic_set.h"
#include "model/evaluation/judge/motion_classifier.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::experiments {

// The figures of a repeated experiment: a row's values by column and trial. Rows may lack trials.
class Trials {
 public:
  explicit Trials(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  // `trial` identifies what was drawn (split, seed): equal trials of two rows are a pair.
  // Shapes: values [columns].
  void Add(const std::string& row, const std::string& trial, std::vector<double> values);

  // The means and the standard deviations (divisor n - 1; NaN for fewer than 2 trials) over each
  // row's trials, rows in the order of their first Add.
  report::Table Means(const std::string& title) const;
  report::Table Deviations(const std::string& title) const;

  // The differences between every other row's figures and those of row `base`, over the trials that
  // both have: their mean, their deviation, and the share of trials in which they are above 0, as
  // rows "more", "more, deviation", "more, share above 0" for a row "more". Empty without `base`.
  report::Table Gains(const std::string& title, const std::string& base) const;

 private:
  using Row = std::map<std::string, std::vector<double>>;  // by trial
  using Figure = double (*)(const std::vector<double>& trials);

  report::Table EmptyTable(const std::string& title) const;
  // A figure of each column.
  std::vector<double> OverTrials(const Row& row, Figure figure) const;

  std::vector<std::string> columns_;
  std::vector<std::pair<std::string, Row>> rows_;
};

// The training data of a classifier.
struct TrainingMaterial {
  std::vector<int> captured;                 // sequences of the data set
  std::vector<dataset::Sequence> synthetic;  // each in its class
};

// Trains a classifier on the material and tests it on captured followers. Returns the accuracy of
// each class, then their mean. Errors: those of MotionClassifier::Train.
absl::StatusOr<std::vector<double>> ClassifierAccuracy(
    const dataset::Dataset& dataset, const TrainingMaterial& material, const std::vector<int>& test,
    const judge::MotionClassifierOptions& options);

// A half of the data, and the synthetic motions made from it.
struct DataHalf {
  uint64_t seed = 0;  // of SplitInHalves
  dataset::Split split;
  std::vector<dataset::Sequence> synthetic;  // made in this process; not empty
  std::vector<dataset::Sequence> served;     // made by a server; empty without a set
};

struct HalfOptions {
  std::string synthetic_row;  // the name of the row with DataHalf::synthetic
  int64_t epochs = 60;        // of a classifier on the captured half
  int repeats = 1;            // classifiers with different seeds
};

// The row that others are compared with.
inline constexpr char kCapturedRow[] = "captured";

// Assigns every set to its half. Errors: INVALID_ARGUMENT naming a set whose half is missing.
absl::Status AddServedSets(const std::vector<SyntheticSet>& sets, std::vector<DataHalf>* halves);

// Trains and tests every row's classifiers on a half. Longer training changes the accuracy by
// itself, and more motions mean more steps per epoch. Therefore every row takes as many steps as
// the captured motions do in options.epochs. Two further rows, with suffix ", longer", are captured
// motions with and without synthetic ones, both for as many steps as the larger set takes in
// options.epochs. Writes a line for each classifier to `progress`.
absl::Status RunHalf(const dataset::Dataset& dataset, const DataHalf& half,
                     const HalfOptions& options, std::ostream* progress, Trials* trials);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_AUGMENTATION_H_
