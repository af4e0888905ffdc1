#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_DATA_HALF_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_DATA_HALF_H_

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/experiments/synthetic_files.h"
#include "model/evaluation/experiments/trials.h"

namespace duet::evaluation::experiments {

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

// The rows of the experiment; HalfOptions names one more.
inline constexpr char kCapturedRow[] = "captured";
inline constexpr char kLonger[] = ", longer";  // suffix of two rows
inline constexpr char kSyntheticAloneRow[] = "synthetic alone";
inline constexpr char kServedRow[] = "captured + set through the server";

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

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_DATA_HALF_H_
