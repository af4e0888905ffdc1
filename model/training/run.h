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
//   state         the state after the last completed epoch, to resume from
//   log.csv       one row per epoch
//   checkpoint/   the result, <name>/<version>/, after the run has finished
struct RunPlan {
  TrainingOptions options;
  std::string model_name;
  int model_version = 1;
  std::string description;
  std::string title;  // of the progress line
  std::filesystem::path folder;
  std::vector<int> train;  // sequences of the data set
  // Folder of a checkpoint of the same architecture, joints and classes whose weights the run
  // begins with; empty: random weights.
  std::filesystem::path from;
  // LibTorch's device: "cpu" or "cuda". Only sampling generators train on "cuda".
  std::string device = "cpu";
};

// Runs to the end, resuming a run that was killed. Returns immediately if the run has already
// finished. Writes progress to `progress`; on a terminal, it rewrites one line.
absl::Status RunTraining(const RunPlan& plan, const dataset::Dataset& dataset, bool terminal,
                         std::ostream* progress);

// Prepares the whole process for training: sets LibTorch's threads, and keeps memory between steps.
// Results are bit-identical between runs only with one thread. INTERNAL if LibTorch cannot identify
// the processor.
absl::Status SetTrainingThreads(int threads);

// The folder of a finished run's checkpoint.
std::filesystem::path CheckpointFolder(const RunPlan& plan);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_RUN_H_
