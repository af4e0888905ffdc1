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
#include "model/engine/synthesizer.h"
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

// A request for a synthetic motion.
struct SyntheticJob {
  dataset::Sequence sequence;  // a leader of its class; the follower has no positions
  std::vector<float> labels;   // [classes], the label vector
};

struct SyntheticPlanOptions {
  int match = 25;  // motions per class by interaction match
  int mix = 25;    // motions per class by interaction mix
  uint64_t seed = 0;
};

// The jobs for synthetic followers of every class; only the seed determines the draw.
//
// Leaders are those of `train`, those of each class in turn as often as needed, with variations:
// both people exchanged in half of the clips of symmetric classes, bodies larger or smaller by up
// to 8 %, turned by about 6 degrees, played up to 10 % faster or slower. Interaction match gives
// the leader's class a weight of 0.75 to 1.25. Interaction mix gives it 0.75 to 1, and one other
// class 0.1 to 0.35, so that the motion stays one of its class.
//
// Source: paper section 4 (300 synthetic motions, 50 a class, "25 + 25"), which does not say how it
//         varies leaders and weights; read as 25 by interaction match and 25 by interaction mix.
// Shapes: returns match + mix jobs per class, sorted by class; ids "<class>-<place in the set>".
// Requires a sequence of every class in `train`; mix above 0 requires two classes.
std::vector<SyntheticJob> PlanSyntheticSet(const dataset::Dataset& dataset,
                                           const std::vector<int>& train,
                                           const SyntheticPlanOptions& options);

// Answers the jobs in this process, through the same windows as on a server.
// Errors: those of CheckModelFits; a failure of the network, naming the job.
absl::StatusOr<std::vector<dataset::Sequence>> SynthesizeJobs(
    const dataset::Dataset& dataset, const engine::Synthesizer& synthesizer,
    const std::vector<SyntheticJob>& jobs);

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
  std::vector<dataset::Sequence> synthetic;  // not empty
};

struct HalfOptions {
  std::string synthetic_row;  // the name of the row with DataHalf::synthetic
  int64_t epochs = 60;        // of a classifier on the captured half
  int repeats = 1;            // classifiers with different seeds
};

// The row that others are compared with.
inline constexpr char kCapturedRow[] = "captured";

// Trains and tests every row's classifiers on a half. Longer training changes the accuracy by
// itself, and more motions mean more steps per epoch. Therefore every row takes as many steps as
// the captured motions do in options.epochs. Two further rows, with suffix ", longer", are captured
// motions with and without synthetic ones, both for as many steps as the larger set takes in
// options.epochs. Writes a line for each classifier to `progress`.
absl::Status RunHalf(const dataset::Dataset& dataset, const DataHalf& half,
                     const HalfOptions& options, std::ostream* progress, Trials* trials);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_AUGMENTATION_H_
