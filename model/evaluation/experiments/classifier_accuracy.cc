#include "model/evaluation/experiments/classifier_accuracy.h"

#include <cstddef>

#include "model/evaluation/metrics/confusion.h"
#include "model/evaluation/metrics/scores.h"

namespace duet::evaluation::experiments {
absl::StatusOr<std::vector<double>> ClassifierAccuracy(
    const dataset::Dataset& dataset, const TrainingMaterial& material, const std::vector<int>& test,
    const judge::MotionClassifierOptions& options) {
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
  metrics::Confusion confusion(dataset.class_count());
  confusion.AddLikeliest(metrics::ClassesOf(dataset, test),
                         classifier->Probabilities(all, metrics::CapturedMotions(all, test)));
  std::vector<double> accuracy = confusion.ClassAccuracies();
  accuracy.push_back(confusion.MeanClassAccuracy());
  return accuracy;
}

}  // namespace duet::evaluation::experiments
