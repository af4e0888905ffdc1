#include "model/evaluation/program/fold_judge.h"

#include <chrono>
#include <iostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace duet::evaluation::program {
namespace {

// The results of one network for an unseen person depend on its seed: several are averaged.
constexpr int64_t kMembers = 4;

}  // namespace

absl::StatusOr<judge::MotionClassifier> TrainFoldJudge(const dataset::Dataset& dataset,
                                                       const Fold& fold) {
  judge::MotionClassifierOptions options;
  options.members = kMembers;
  const auto start = std::chrono::steady_clock::now();
  absl::StatusOr<judge::MotionClassifier> judge = judge::MotionClassifier::Train(
      dataset, metrics::CapturedMotions(dataset, fold.split.train), options);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::cerr << absl::StrFormat("judge without %s: %d motions, %.1f s\n", fold.subject,
                               fold.split.train.size(), seconds);
  return judge;
}

std::pair<std::string, std::string> JudgeSetting(const Fold& fold,
                                                 const judge::MotionClassifier& judge) {
  return {absl::StrCat("judge without ", fold.subject, ", SHA-256"), judge.hash()};
}

metrics::JudgedFold JudgeMotions(const judge::MotionClassifier& judge,
                                 const dataset::Dataset& dataset,
                                 const std::vector<metrics::ScoredMotion>& motions) {
  metrics::JudgedFold judged;
  for (const metrics::ScoredMotion& motion : motions) {
    judged.classes.push_back(SequenceOf(dataset, motion).interaction_class);
  }
  judged.probabilities = judge.Probabilities(dataset, motions);
  judged.features = judge.Features(dataset, motions);
  return judged;
}

}  // namespace duet::evaluation::program
