#include "model/evaluation/experiments/told_apart.h"

#include <utility>

#include "absl/status/status.h"
#include "model/base/status_macros.h"
#include "model/evaluation/metrics/judged_scores.h"
#include "model/motion/filter.h"

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
    dataset::Sequence sequence = SequenceOf(dataset, answer);
    motion::ClipPair& pair = sequence.pair;
    const double rate = pair.leader.frame_rate_hz;
    pair.leader.poses = motion::WithoutNoise(pair.leader.poses, rate);
    pair.follower.poses = motion::WithoutNoise(pair.follower.poses, rate);
    sequence.interaction_class = kCaptured;
    pairs.sequences.push_back(sequence);
    pair.follower.poses = motion::WithoutNoise(answer.follower, rate);
    sequence.interaction_class = kSynthesised;
    pairs.sequences.push_back(std::move(sequence));
  }
  return pairs;
}

}  // namespace

judge::MotionClassifierOptions ToldApartOptions(uint64_t seed) {
  judge::MotionClassifierOptions options;
  options.sees = judge::Sees::kBoth;
  options.body_noise = 0.01;
  options.seed = seed;
  return options;
}

absl::StatusOr<double> ToldApart(const dataset::Dataset& dataset,
                                 const std::vector<metrics::ScoredMotion>& training_answers,
                                 const std::vector<metrics::ScoredMotion>& test_answers,
                                 const judge::MotionClassifierOptions& options) {
  if (test_answers.empty()) {
    return absl::InvalidArgumentError("test answers: expected at least one, got none");
  }
  const dataset::Dataset training = PairsToTell(dataset, training_answers);
  DUET_TRY(
      const auto classifier,
      judge::MotionClassifier::Train(
          training, metrics::CapturedMotions(training, dataset::AllSequences(training)), options));
  const dataset::Dataset test = PairsToTell(dataset, test_answers);
  const std::vector<int> all = dataset::AllSequences(test);
  metrics::Confusion confusion(test.class_count());
  confusion.AddLikeliest(metrics::ClassesOf(test, all),
                         classifier.Probabilities(test, metrics::CapturedMotions(test, all)));
  return confusion.MeanClassAccuracy();
}

}  // namespace duet::evaluation::experiments
