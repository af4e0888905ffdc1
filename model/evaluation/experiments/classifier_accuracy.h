#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_CLASSIFIER_ACCURACY_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_CLASSIFIER_ACCURACY_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/judge/motion_classifier.h"

namespace duet::evaluation::experiments {

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

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_CLASSIFIER_ACCURACY_H_
