#include "model/evaluation/program/fold_scorer.h"

#include <chrono>
#include <cstddef>
#include <iostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/status_macros.h"
#include "model/evaluation/report/metric_tables.h"
#include "model/motion/filter.h"

namespace duet::evaluation::program {
namespace {

// The results of one network for an unseen person depend on its seed: several are averaged.
constexpr int64_t kMembers = 4;

using metrics::FiguresByMetric;
using metrics::JudgedFold;
using metrics::SampledMotions;
using metrics::ScoredMotion;

OneAnswerEach Filtered(const dataset::Dataset& dataset, OneAnswerEach folds) {
  for (std::vector<ScoredMotion>& motions : folds) {
    for (ScoredMotion& motion : motions) {
      const double rate = SequenceOf(dataset, motion).pair.leader.frame_rate_hz;
      motion.follower = motion::WithoutNoise(motion.follower, rate);
    }
  }
  return folds;
}

// All folds' answers as one set of folds: the n-th set of every fold, one after the other. All
// folds have the same number of sets.
SampledMotions JoinFolds(const std::vector<SampledMotions>& answers) {
  SampledMotions joined(answers.empty() ? 0 : answers.front().size());
  for (const SampledMotions& fold : answers) {
    for (size_t n = 0; n < joined.size(); ++n) {
      joined[n].insert(joined[n].end(), fold[n].begin(), fold[n].end());
    }
  }
  return joined;
}

FiguresByMetric Distances(const dataset::Dataset& dataset, const SampledMotions& answers) {
  FiguresByMetric figures = ScoreByClass(dataset, Pool(answers));
  FiguresByMetric of_mean = ScoreByClass(dataset, MeanAnswers(answers));
  FiguresByMetric of_best = ScoreByClass(dataset, BestAnswers(dataset, answers));
  figures[report::kMeanAnswerAfd] = std::move(of_mean["afd"]);
  figures[report::kMeanAnswerAfdMetres] = std::move(of_mean["afd_m"]);
  figures[report::kBestAnswerAfd] = std::move(of_best["afd"]);
  figures[report::kBestAnswerAfdMetres] = std::move(of_best["afd_m"]);
  figures[report::kMultimodality] = MultimodalityByClass(dataset, answers);
  return figures;
}

// Adds values / count to sums, which may still be empty.
void AddShare(const std::vector<double>& values, size_t count, std::vector<double>* sums) {
  sums->resize(values.size());
  for (size_t i = 0; i < values.size(); ++i) (*sums)[i] += values[i] / static_cast<double>(count);
}

// A judge's results for motions, each requested in its sequence's class.
JudgedFold JudgeMotions(const judge::MotionClassifier& judge, const dataset::Dataset& dataset,
                        const std::vector<ScoredMotion>& motions) {
  JudgedFold judged;
  for (const ScoredMotion& motion : motions) {
    judged.classes.push_back(SequenceOf(dataset, motion).interaction_class);
  }
  judged.probabilities = judge.Probabilities(dataset, motions);
  judged.features = judge.Features(dataset, motions);
  return judged;
}

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

absl::StatusOr<FoldScorer> FoldScorer::Create(const dataset::Dataset& dataset,
                                              std::vector<Fold> folds, Judging judging) {
  FoldScorer scorer(dataset);
  scorer.folds_ = std::move(folds);
  for (const Fold& fold : scorer.folds_) {
    scorer.captured_.push_back(metrics::CapturedMotions(dataset, fold.split.test));
    if (judging == Judging::kNone) continue;
    DUET_TRY(judge::MotionClassifier judge, TrainFoldJudge(dataset, fold));
    scorer.judges_.push_back(std::move(judge));
  }
  if (judging != Judging::kNone) scorer.judged_captured_ = scorer.Judge(scorer.captured_);
  if (judging == Judging::kFiltered) {
    scorer.judged_filtered_ = scorer.Judge(Filtered(dataset, scorer.captured_));
  }
  return scorer;
}

std::vector<JudgedFold> FoldScorer::Judge(const OneAnswerEach& answers) const {
  std::vector<JudgedFold> judged;
  for (size_t i = 0; i < folds_.size(); ++i) {
    judged.push_back(JudgeMotions(judges_[i], *dataset_, answers[i]));
  }
  return judged;
}

absl::StatusOr<report::MethodFigures> FoldScorer::Score(const std::string& row,
                                                        const OneAnswerEach& answers) const {
  report::MethodFigures figures{row, /*captured=*/false, ScoreByClass(*dataset_, Pool(answers))};
  if (judges_.empty()) return figures;
  const int classes = dataset_->class_count();
  const std::vector<JudgedFold> made = Judge(answers);
  DUET_TRY(figures.by_metric[report::kFrechet], FrechetByClass(made, judged_captured_, classes));
  figures.by_metric[report::kAccuracy] = AccuracyByClass(made, classes);
  figures.by_metric[report::kDiversity] = DiversityByClass(made, classes);
  return figures;
}

absl::StatusOr<report::MethodFigures> FoldScorer::ScoreCaptured() const {
  DUET_TRY(report::MethodFigures figures, Score("captured", captured_));
  figures.captured = true;
  return figures;
}

absl::StatusOr<report::MethodFigures> FoldScorer::ScoreSamples(
    const std::string& row, const std::vector<SampledMotions>& answers) const {
  report::MethodFigures figures{row, /*captured=*/false, Distances(*dataset_, JoinFolds(answers))};
  const int classes = dataset_->class_count();
  const size_t count = answers.empty() ? 0 : answers.front().size();
  FiguresByMetric& by_metric = figures.by_metric;
  for (size_t n = 0; n < count; ++n) {
    OneAnswerEach set;
    for (const SampledMotions& of_fold : answers) set.push_back(of_fold[n]);
    const std::vector<JudgedFold> made = Judge(set), filtered = Judge(Filtered(*dataset_, set));
    DUET_TRY(double distance, PooledFrechet(made, judged_captured_));
    DUET_TRY(double filtered_distance, PooledFrechet(filtered, judged_filtered_));
    AddShare({distance}, count, &by_metric[report::kPooledFrechet]);
    AddShare({filtered_distance}, count, &by_metric[report::kFilteredFrechet]);
    AddShare(AccuracyByClass(made, classes), count, &by_metric[report::kAccuracy]);
    AddShare(DiversityByClass(made, classes), count, &by_metric[report::kDiversity]);
    AddShare(DiversityByClass(filtered, classes), count, &by_metric[report::kFilteredDiversity]);
  }
  return figures;
}

absl::StatusOr<report::MethodFigures> FoldScorer::ScoreCapturedSamples() const {
  std::vector<SampledMotions> once;
  for (const std::vector<ScoredMotion>& fold : captured_) once.push_back({fold});
  DUET_TRY(report::MethodFigures figures, ScoreSamples("captured", once));
  figures.captured = true;
  return figures;
}

std::vector<std::pair<std::string, std::string>> FoldScorer::JudgeSettings() const {
  std::vector<std::pair<std::string, std::string>> settings;
  for (size_t i = 0; i < judges_.size(); ++i) {
    settings.push_back(JudgeSetting(folds_[i], judges_[i]));
  }
  return settings;
}

}  // namespace duet::evaluation::program
