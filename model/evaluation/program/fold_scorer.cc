#include "model/evaluation/program/fold_scorer.h"

#include <cstddef>
#include <iostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/evaluation/metrics/scores.h"

namespace duet::evaluation::program {
namespace {

void AddScores(const dataset::Dataset& dataset, const std::vector<protocol::FoldResult>& results,
               report::MethodFigures* figures) {
  const std::vector<std::vector<double>> scores = ScoreByClass(dataset, PoolMotions(results));
  for (size_t m = 0; m < metrics::AllMetrics().size(); ++m) {
    std::vector<double>& column = figures->by_metric[metrics::MetricName(metrics::AllMetrics()[m])];
    for (const std::vector<double>& of_class : scores) column.push_back(of_class[m]);
  }
}

}  // namespace

absl::StatusOr<FoldScorer> FoldScorer::Create(const dataset::Dataset& dataset,
                                              const std::vector<std::string>& subjects,
                                              bool judged) {
  FoldScorer scorer(dataset);
  for (const std::string& subject : subjects) {
    absl::StatusOr<dataset::Split> split = LeaveSubjectOut(dataset, subject);
    if (!split.ok()) return split.status();
    scorer.folds_.push_back({subject, *std::move(split), {}, {}});
    if (!judged) continue;
    absl::Status status = scorer.AddJudge(&scorer.folds_.back());
    if (!status.ok()) return status;
  }
  return scorer;
}

absl::Status FoldScorer::AddJudge(Fold* fold) const {
  absl::StatusOr<judge::MotionClassifier> judge = TrainFoldJudge(*dataset_, fold->subject);
  if (!judge.ok()) return judge.status();
  fold->judge.push_back(*std::move(judge));
  fold->captured = JudgeMotions(fold->judge.front(), *dataset_,
                                metrics::CapturedMotions(*dataset_, fold->split.test));
  return absl::OkStatus();
}

absl::StatusOr<report::MethodFigures> FoldScorer::Score(const std::string& row,
                                                        const MakeMethod& make) const {
  std::vector<protocol::FoldResult> results;
  for (const Fold& fold : folds_) {
    absl::StatusOr<std::unique_ptr<protocol::Method>> method = make(fold.subject);
    if (!method.ok()) return method.status();
    absl::StatusOr<protocol::FoldResult> result =
        RunFold(*dataset_, fold.split, fold.subject, method->get());
    if (!result.ok()) return result.status();
    std::cerr << absl::StrFormat(
        "%s without %s: trained in %.1f s, answered %d leaders in %.1f s\n", row, fold.subject,
        result->train_seconds, result->motions.size(), result->predict_seconds);
    results.push_back(*std::move(result));
  }
  return Figures(row, results);
}

absl::StatusOr<report::MethodFigures> FoldScorer::ScoreCaptured() const {
  std::vector<protocol::FoldResult> results;
  for (const Fold& fold : folds_) {
    results.push_back({fold.subject, metrics::CapturedMotions(*dataset_, fold.split.test), 0, 0});
  }
  absl::StatusOr<report::MethodFigures> figures = Figures("captured", results);
  if (figures.ok()) figures->captured = true;
  return figures;
}

absl::StatusOr<report::MethodFigures> FoldScorer::Figures(
    const std::string& row, const std::vector<protocol::FoldResult>& results) const {
  report::MethodFigures figures{row, /*captured=*/false, {}};
  AddScores(*dataset_, results, &figures);
  std::vector<metrics::JudgedFold> made, captured;
  for (size_t i = 0; i < folds_.size(); ++i) {
    if (folds_[i].judge.empty()) return figures;
    made.push_back(JudgeMotions(folds_[i].judge.front(), *dataset_, results[i].motions));
    captured.push_back(folds_[i].captured);
  }
  const int classes = dataset_->class_count();
  absl::StatusOr<std::vector<double>> frechet = FrechetByClass(made, captured, classes);
  if (!frechet.ok()) return frechet.status();
  figures.by_metric[report::kAccuracy] = AccuracyByClass(made, classes);
  figures.by_metric[report::kFrechet] = *std::move(frechet);
  figures.by_metric[report::kDiversity] = DiversityByClass(made, classes);
  return figures;
}

std::vector<std::pair<std::string, std::string>> FoldScorer::JudgeSettings() const {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const Fold& fold : folds_) {
    if (fold.judge.empty()) continue;
    settings.emplace_back(absl::StrCat("judge without ", fold.subject, ", SHA-256"),
                          fold.judge.front().hash());
  }
  return settings;
}

}  // namespace duet::evaluation::program
