#include "model/evaluation/experiments/classifier_accuracy.h"

#include <algorithm>
#include <cstddef>

#include "model/evaluation/metrics/confusion.h"
#include "model/evaluation/metrics/scores.h"

namespace duet::evaluation::experiments {
namespace {

int Largest(const std::vector<float>& values) {
  return static_cast<int>(std::max_element(values.begin(), values.end()) - values.begin());
}

}  // namespace

absl::StatusOr<std::vector<double>> ClassifierAccuracy(const dataset::Dataset& dataset,
                                                       const TrainingMaterial& material,
                                                       const std::vector<int>& test,
                                                       const judge::ClassifierOptions& options) {
  // Synthetic pairs have their own leaders: they are added to the data set like captured ones.
  dataset::Dataset all = dataset;
  std::vector<int> train = material.captured;
  for (const dataset::Sequence& sequence : material.synthetic) {
    train.push_back(static_cast<int>(all.sequences.size()));
    all.sequences.push_back(sequence);
  }
  absl::StatusOr<judge::MotionClassifier> classifier =
      judge::MotionClassifier::Train(all, metrics::CapturedMotions(all, train), options);
  if (!classifier.ok()) return classifier.status();
  const std::vector<std::vector<float>> probabilities =
      classifier->Probabilities(all, metrics::CapturedMotions(all, test));
  metrics::Confusion confusion(dataset.class_count());
  for (size_t i = 0; i < test.size(); ++i) {
    confusion.Add(all.sequences[static_cast<size_t>(test[i])].interaction_class,
                  Largest(probabilities[i]));
  }
  std::vector<double> accuracy;
  for (int c = 0; c < dataset.class_count(); ++c) accuracy.push_back(confusion.ClassAccuracy(c));
  accuracy.push_back(confusion.MeanClassAccuracy());
  return accuracy;
}

}  // namespace duet::evaluation::experiments
