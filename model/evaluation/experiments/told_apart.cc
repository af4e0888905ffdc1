#include "model/evaluation/experiments/told_apart.h"

#include <cstddef>
#include <numeric>
#include <utility>

#include "absl/status/status.h"
#include "model/evaluation/metrics/confusion.h"
#include "model/evaluation/metrics/liveliness.h"

namespace duet::evaluation::experiments {
namespace {

constexpr int kCaptured = 0, kSynthesised = 1;

// A data set of two classes: pairs with captured followers, and pairs with synthesised ones.
dataset::Dataset PairsToTell(const dataset::Dataset& dataset,
                             const std::vector<metrics::ScoredMotion>& answers) {
  dataset::Dataset pairs = dataset;
  pairs.classes = {"captured", "synthesised"};
  pairs.symmetric = {false, false};
  pairs.handed = {false, false};
  pairs.touches = {false, false};
  pairs.sequences.clear();
  for (const metrics::ScoredMotion& answer : answers) {
    dataset::Sequence sequence = dataset.sequences[static_cast<size_t>(answer.sequence)];
    motion::ClipPair& pair = sequence.pair;
    const double rate = pair.leader.frame_rate_hz;
    pair.leader.poses = metrics::WithoutNoise(pair.leader.poses, rate);
    pair.follower.poses = metrics::WithoutNoise(pair.follower.poses, rate);
    sequence.interaction_class = kCaptured;
    pairs.sequences.push_back(sequence);
    pair.follower.poses = metrics::WithoutNoise(answer.follower, rate);
    sequence.interaction_class = kSynthesised;
    pairs.sequences.push_back(std::move(sequence));
  }
  return pairs;
}

std::vector<metrics::ScoredMotion> All(const dataset::Dataset& pairs) {
  std::vector<int> all(pairs.sequences.size());
  std::iota(all.begin(), all.end(), 0);
  return metrics::CapturedMotions(pairs, all);
}

}  // namespace

judge::ClassifierOptions ToldApartOptions(uint64_t seed) {
  judge::ClassifierOptions options;
  options.sees = judge::JudgeSees::kBoth;
  options.body_noise = 0.01;
  options.seed = seed;
  return options;
}

absl::StatusOr<double> ToldApart(const dataset::Dataset& dataset,
                                 const std::vector<metrics::ScoredMotion>& training_answers,
                                 const std::vector<metrics::ScoredMotion>& test_answers,
                                 const judge::ClassifierOptions& options) {
  if (test_answers.empty()) {
    return absl::InvalidArgumentError("test answers: none, wanted one or more");
  }
  const dataset::Dataset training = PairsToTell(dataset, training_answers);
  const absl::StatusOr<judge::MotionClassifier> classifier =
      judge::MotionClassifier::Train(training, All(training), options);
  if (!classifier.ok()) return classifier.status();
  const dataset::Dataset test = PairsToTell(dataset, test_answers);
  const std::vector<std::vector<float>> probabilities = classifier->Probabilities(test, All(test));
  metrics::Confusion confusion(2);
  for (size_t i = 0; i < probabilities.size(); ++i) {
    const bool synthesised = probabilities[i][kSynthesised] > probabilities[i][kCaptured];
    confusion.Add(test.sequences[i].interaction_class, synthesised ? kSynthesised : kCaptured);
  }
  return confusion.MeanClassAccuracy();
}

}  // namespace duet::evaluation::experiments
