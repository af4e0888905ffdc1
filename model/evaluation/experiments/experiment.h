#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_EXPERIMENT_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_EXPERIMENT_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/engine/synthesizer.h"
#include "model/evaluation/experiments/synthetic_plan.h"
#include "model/evaluation/judge/classifier.h"

namespace duet::evaluation::experiments {

// The jobs answered in this process, through the windows that a server would make of them. Errors:
// those of CheckModelFits; a failure of the network, naming the job.
absl::StatusOr<std::vector<dataset::Sequence>> SynthesizeJobs(
    const dataset::Dataset& dataset, const engine::Synthesizer& synthesizer,
    const std::vector<SyntheticJob>& jobs);

// What a classifier learns from.
struct TrainingMaterial {
  std::vector<int> captured;                 // sequences of the data set
  std::vector<dataset::Sequence> synthetic;  // each in its class
};

// Trains a classifier on the material and tests it on captured followers. Returns the accuracy of
// each class, then their mean. Errors: those of MotionClassifier::Train.
absl::StatusOr<std::vector<double>> ClassifierAccuracy(const dataset::Dataset& dataset,
                                                       const TrainingMaterial& material,
                                                       const std::vector<int>& test,
                                                       const judge::ClassifierOptions& options);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_EXPERIMENT_H_
