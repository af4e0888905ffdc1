#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_AUGMENTATION_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_AUGMENTATION_H_

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/engine/synthesizer.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::experiments {

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

// The accuracies of one kind of training data by trial. Shapes: trials [halves x repeats][classes
// + 1]: of each class, then their mean.
struct AccuracyRow {
  std::string name;
  std::vector<std::vector<double>> trials;
};

// Trains and tests every row's classifiers on a half, and adds their trials to the rows. Longer
// training changes the accuracy by itself, and more motions mean more steps per epoch. Therefore
// every row takes as many steps as the captured motions do in options.epochs. Two further rows,
// with suffix ", longer", are captured motions with and without synthetic ones, both for as many
// steps as the larger set takes in options.epochs. The first row is captured motions alone. Writes
// a line for each classifier to `progress`. Errors: those of MotionClassifier::Train.
absl::Status RunHalf(const dataset::Dataset& dataset, const DataHalf& half,
                     const HalfOptions& options, std::ostream* progress,
                     std::vector<AccuracyRow>* rows);

// The means and the standard deviations (divisor n - 1; NaN for fewer than 2 trials) over each
// row's trials; and the gains of every row over the first one in the same trial: their mean, their
// deviation, and the share of trials in which they are above 0.
std::vector<report::Table> AccuracyTables(const std::vector<std::string>& classes,
                                          const std::vector<AccuracyRow>& rows);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_AUGMENTATION_H_
