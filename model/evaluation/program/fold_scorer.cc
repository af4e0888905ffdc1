#include "model/evaluation/program/fold_scorer.h"

#include <cstddef>

#include "model/evaluation/report/sample_tables.h"
#include "model/motion/filter.h"

namespace duet::evaluation::program {
namespace {

using metrics::FiguresByMetric;
using metrics::JudgedFold;
using metrics::SampledMotions;
using metrics::ScoredMotion;

std::vector<ScoredMotion> Filtered(const dataset::Dataset& dataset,
                                   std::vector<ScoredMotion> motions) {
  for (ScoredMotion& motion : motions) {
    const double rate = SequenceOf(dataset, motion).pair.leader.frame_rate_hz;
    motion.follower = motion::WithoutNoise(motion.follower, rate);
  }
  return motions;
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

absl::StatusOr<report::MethodFigures> AsCaptured(absl::StatusOr<report::MethodFigures> figures) {
  if (figures.ok()) figures->captured = true;
  return figures;
}

}  // namespace

absl::StatusOr<FoldScorer> FoldScorer::Create(const dataset::Dataset& dataset,
                                              std::vector<Fold> folds, Judging judging) {
  FoldScorer scorer(dataset);
  scorer.folds_ = std::move(folds);
  for (const Fold& fold : scorer.folds_) {
    scorer.captured_.push_back(metrics::CapturedMotions(dataset, fold.split.test));
    if (judging == Judging::kNone) continue;
    absl::Status status = scorer.AddJudge(fold, judging);
    if (!status.ok()) return status;
  }
  return scorer;
}

absl::Status FoldScorer::AddJudge(const Fold& fold, Judging judging) {
  absl::StatusOr<judge::MotionClassifier> judge = TrainFoldJudge(*dataset_, fold);
  if (!judge.ok()) return judge.status();
  const std::vector<ScoredMotion>& captured = captured_.back();
  judged_captured_.push_back(JudgeMotions(*judge, *dataset_, captured));
  if (judging == Judging::kFiltered) {
    judged_filtered_.push_back(JudgeMotions(*judge, *dataset_, Filtered(*dataset_, captured)));
  }
  judges_.push_back(*std::move(judge));
  return absl::OkStatus();
}

absl::StatusOr<report::MethodFigures> FoldScorer::Score(
    const std::string& row, const std::vector<std::vector<ScoredMotion>>& answers) const {
  report::MethodFigures figures{row, /*captured=*/false, ScoreByClass(*dataset_, Pool(answers))};
  if (judges_.empty()) return figures;
  std::vector<JudgedFold> made;
  for (size_t i = 0; i < folds_.size(); ++i) {
    made.push_back(JudgeMotions(judges_[i], *dataset_, answers[i]));
  }
  const int classes = dataset_->class_count();
  absl::StatusOr<std::vector<double>> frechet = FrechetByClass(made, judged_captured_, classes);
  if (!frechet.ok()) return frechet.status();
  figures.by_metric[report::kAccuracy] = AccuracyByClass(made, classes);
  figures.by_metric[report::kFrechet] = *std::move(frechet);
  figures.by_metric[report::kDiversity] = DiversityByClass(made, classes);
  return figures;
}

absl::StatusOr<report::MethodFigures> FoldScorer::ScoreCaptured() const {
  return AsCaptured(Score("captured", captured_));
}

absl::StatusOr<report::MethodFigures> FoldScorer::ScoreSamples(
    const std::string& row, const std::vector<SampledMotions>& answers) const {
  report::MethodFigures figures{row, /*captured=*/false, Distances(*dataset_, JoinFolds(answers))};
  absl::Status status = AddJudged(answers, &figures);
  if (!status.ok()) return status;
  return figures;
}

absl::Status FoldScorer::AddJudged(const std::vector<SampledMotions>& answers,
                                   report::MethodFigures* figures) const {
  const int classes = dataset_->class_count();
  const size_t count = answers.empty() ? 0 : answers.front().size();
  FiguresByMetric& by_metric = figures->by_metric;
  for (size_t n = 0; n < count; ++n) {
    std::vector<JudgedFold> made, filtered;
    for (size_t i = 0; i < folds_.size(); ++i) {
      made.push_back(JudgeMotions(judges_[i], *dataset_, answers[i][n]));
      filtered.push_back(JudgeMotions(judges_[i], *dataset_, Filtered(*dataset_, answers[i][n])));
    }
    absl::StatusOr<double> distance = PooledFrechet(made, judged_captured_);
    if (!distance.ok()) return distance.status();
    absl::StatusOr<double> filtered_distance = PooledFrechet(filtered, judged_filtered_);
    if (!filtered_distance.ok()) return filtered_distance.status();
    AddShare({*distance}, count, &by_metric[report::kPooledFrechet]);
    AddShare({*filtered_distance}, count, &by_metric[report::kFilteredFrechet]);
    AddShare(AccuracyByClass(made, classes), count, &by_metric[report::kAccuracy]);
    AddShare(DiversityByClass(made, classes), count, &by_metric[report::kDiversity]);
    AddShare(DiversityByClass(filtered, classes), count, &by_metric[report::kFilteredDiversity]);
  }
  return absl::OkStatus();
}

absl::StatusOr<report::MethodFigures> FoldScorer::ScoreCapturedSamples() const {
  std::vector<SampledMotions> once;
  for (const std::vector<ScoredMotion>& fold : captured_) once.push_back({fold});
  return AsCaptured(ScoreSamples("captured", once));
}

std::vector<std::pair<std::string, std::string>> FoldScorer::JudgeSettings() const {
  std::vector<std::pair<std::string, std::string>> settings;
  for (size_t i = 0; i < judges_.size(); ++i) {
    settings.push_back(JudgeSetting(folds_[i], judges_[i]));
  }
  return settings;
}

}  // namespace duet::evaluation::program
