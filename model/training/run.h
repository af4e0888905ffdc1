#ifndef DUET_MODEL_TRAINING_RUN_H_
#define DUET_MODEL_TRAINING_RUN_H_

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/dataset/dataset.h"
#include "model/training/options.h"

namespace duet::training {

// One training run and its folder:
//   state         everything to go on from after the last finished epoch
//   log.csv       one row an epoch
//   checkpoint/   the result, <name>/<version>/, once the run has finished
struct RunPlan {
  TrainingOptions options;
  std::string model_name;
  int model_version = 1;
  std::string description;
  std::string title;  // of the progress line
  std::filesystem::path folder;
  std::vector<int> train;  // sequences of the data set
};

// Runs to the end, or goes on where a killed run left off; returns at once when the run has already
// finished. Progress goes to `progress`: a line rewritten in place on a terminal.
absl::Status RunTraining(const RunPlan& plan, const dataset::Dataset& dataset, bool terminal,
                         std::ostream* progress);

// Prepares the whole process for training: LibTorch's threads, and memory kept between steps.
// Results repeat bit for bit with one. INTERNAL where LibTorch cannot find out about the processor.
absl::Status SetTrainingThreads(int threads);

// Where a finished run's checkpoint is.
std::filesystem::path CheckpointFolder(const RunPlan& plan);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_RUN_H_
