#include "model/evaluation/experiments/experiment.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/evaluation/experiments/synthesizer_method.h"
#include "model/evaluation/metrics/confusion.h"

namespace duet::evaluation::experiments {
namespace {

metrics::ScoredMotion Motion(const dataset::Dataset& dataset, int sequence) {
  return {sequence, dataset.sequences[static_cast<size_t>(sequence)].pair.follower.positions};
}

std::vector<metrics::ScoredMotion> Motions(const dataset::Dataset& dataset,
                                           const std::vector<int>& sequences) {
  std::vector<metrics::ScoredMotion> motions;
  for (const int sequence : sequences) motions.push_back(Motion(dataset, sequence));
  return motions;
}

int Largest(const std::vector<float>& values) {
  return static_cast<int>(std::max_element(values.begin(), values.end()) - values.begin());
}

}  // namespace

absl::StatusOr<std::vector<dataset::Sequence>> SynthesizeJobs(
    const dataset::Dataset& dataset, const engine::Synthesizer& synthesizer,
    const std::vector<SyntheticJob>& jobs) {
  absl::Status status = CheckModelFits(synthesizer.description(), dataset);
  if (!status.ok()) return status;
  std::vector<dataset::Sequence> answered;
  for (const SyntheticJob& job : jobs) {
    absl::StatusOr<std::vector<motion::Vec3>> follower =
        SynthesizeSequence(synthesizer, job.sequence, job.labels, StartGiven::kNone);
    if (!follower.ok()) {
      return absl::Status(follower.status().code(),
                          absl::StrCat(job.sequence.id, ": ", follower.status().message()));
    }
    answered.push_back(job.sequence);
    answered.back().pair.follower.positions = *std::move(follower);
  }
  return answered;
}

absl::StatusOr<std::vector<double>> ClassifierAccuracy(const dataset::Dataset& dataset,
                                                       const TrainingMaterial& material,
                                                       const std::vector<int>& test,
                                                       const judge::ClassifierOptions& options) {
  // Synthetic pairs become sequences of their own: their leaders are not the captured ones.
  dataset::Dataset all = dataset;
  std::vector<int> train = material.captured;
  for (const dataset::Sequence& sequence : material.synthetic) {
    train.push_back(static_cast<int>(all.sequences.size()));
    all.sequences.push_back(sequence);
  }
  absl::StatusOr<judge::MotionClassifier> classifier =
      judge::MotionClassifier::Train(all, Motions(all, train), options);
  if (!classifier.ok()) return classifier.status();
  const std::vector<std::vector<float>> probabilities =
      classifier->Probabilities(all, Motions(all, test));
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
