#include "model/evaluation/program/fold_judge.h"

#include <chrono>
#include <cstddef>
#include <iostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/evaluation/metrics/scores.h"

namespace duet::evaluation::program {
namespace {

// The results of one network for an unseen person depend on its seed: several are averaged.
constexpr int64_t kMembers = 4;

}  // namespace

absl::StatusOr<std::vector<std::string>> FoldSubjects(const dataset::Dataset& dataset,
                                                      const std::vector<std::string>& asked) {
  std::vector<std::string> subjects = asked.empty() ? dataset.Subjects() : asked;
  if (!subjects.empty()) return subjects;
  return absl::InvalidArgumentError(
      absl::StrCat(dataset.name, ": no subjects, wanted sequences that name theirs"));
}

absl::StatusOr<judge::MotionClassifier> TrainFoldJudge(const dataset::Dataset& dataset,
                                                       const std::string& subject) {
  absl::StatusOr<dataset::Split> split = LeaveSubjectOut(dataset, subject);
  if (!split.ok()) return split.status();
  judge::ClassifierOptions options;
  options.members = kMembers;
  const auto start = std::chrono::steady_clock::now();
  absl::StatusOr<judge::MotionClassifier> judge = judge::MotionClassifier::Train(
      dataset, metrics::CapturedMotions(dataset, split->train), options);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::cerr << absl::StrFormat("judge without %s: %d motions, %.1f s\n", subject,
                               split->train.size(), seconds);
  return judge;
}

metrics::JudgedFold JudgeMotions(const judge::MotionClassifier& judge,
                                 const dataset::Dataset& dataset,
                                 const std::vector<metrics::ScoredMotion>& motions) {
  metrics::JudgedFold judged;
  for (const metrics::ScoredMotion& motion : motions) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(motion.sequence)];
    judged.classes.push_back(sequence.interaction_class);
  }
  judged.probabilities = judge.Probabilities(dataset, motions);
  judged.features = judge.Features(dataset, motions);
  return judged;
}

}  // namespace duet::evaluation::program
