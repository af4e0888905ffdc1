#include "model/evaluation/program/sample_scorer.h"

#include <algorithm>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "model/evaluation/metrics/liveliness.h"
#include "model/evaluation/report/sample_tables.h"

namespace duet::evaluation::program {
namespace {

using metrics::JudgedFold;
using metrics::SampledMotions;
using metrics::ScoredMotion;

std::vector<ScoredMotion> Filtered(const dataset::Dataset& dataset,
                                   std::vector<ScoredMotion> motions) {
  for (ScoredMotion& motion : motions) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(motion.sequence)];
    motion.follower = metrics::WithoutNoise(motion.follower, sequence.pair.leader.frame_rate_hz);
  }
  return motions;
}

// One metric's column of ScoreByClass's table.
std::vector<double> ColumnOf(const std::vector<std::vector<double>>& scores,
                             metrics::Metric metric) {
  const auto& all = metrics::AllMetrics();
  const auto at = static_cast<size_t>(std::find(all.begin(), all.end(), metric) - all.begin());
  std::vector<double> column;
  for (const std::vector<double>& of_class : scores) column.push_back(of_class[at]);
  return column;
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

void AddDistances(const dataset::Dataset& dataset, const SampledMotions& answers,
                  report::MethodFigures* figures) {
  const auto of_all = ScoreByClass(dataset, Pool(answers));
  for (const metrics::Metric metric : metrics::AllMetrics()) {
    figures->by_metric[MetricName(metric)] = ColumnOf(of_all, metric);
  }
  const auto of_mean = ScoreByClass(dataset, MeanAnswers(answers));
  const auto of_best = ScoreByClass(dataset, BestAnswers(dataset, answers));
  auto& by_metric = figures->by_metric;
  by_metric[report::kMeanAnswerAfd] = ColumnOf(of_mean, metrics::Metric::kAfd);
  by_metric[report::kMeanAnswerAfdMetres] = ColumnOf(of_mean, metrics::Metric::kAfdMetres);
  by_metric[report::kBestAnswerAfd] = ColumnOf(of_best, metrics::Metric::kAfd);
  by_metric[report::kBestAnswerAfdMetres] = ColumnOf(of_best, metrics::Metric::kAfdMetres);
  by_metric[report::kMultimodality] = MultimodalityByClass(dataset, answers);
}

// The judges' results for one set of answers of every fold.
struct JudgedSet {
  std::vector<JudgedFold> plain, filtered;  // [folds]
};

JudgedSet JudgeSet(const dataset::Dataset& dataset, const std::vector<SampleFold>& folds,
                   const std::vector<SampledMotions>& answers, size_t n) {
  JudgedSet set;
  for (size_t i = 0; i < folds.size(); ++i) {
    const judge::MotionClassifier& judge = folds[i].judge.front();
    set.plain.push_back(JudgeMotions(judge, dataset, answers[i][n]));
    set.filtered.push_back(JudgeMotions(judge, dataset, Filtered(dataset, answers[i][n])));
  }
  return set;
}

// Adds values / count to sums, which may still be empty.
void AddShare(const std::vector<double>& values, size_t count, std::vector<double>* sums) {
  sums->resize(values.size());
  for (size_t i = 0; i < values.size(); ++i) (*sums)[i] += values[i] / static_cast<double>(count);
}

}  // namespace

absl::StatusOr<SampleScorer> SampleScorer::Create(const dataset::Dataset& dataset,
                                                  const std::vector<std::string>& subjects) {
  SampleScorer scorer(dataset);
  for (const std::string& subject : subjects) {
    absl::StatusOr<dataset::Split> split = LeaveSubjectOut(dataset, subject);
    if (!split.ok()) return split.status();
    absl::StatusOr<judge::MotionClassifier> judge = TrainFoldJudge(dataset, subject);
    if (!judge.ok()) return judge.status();
    const std::vector<ScoredMotion> captured = metrics::CapturedMotions(dataset, split->test);
    scorer.folds_.push_back({subject,
                             *std::move(split),
                             {*judge},
                             JudgeMotions(*judge, dataset, captured),
                             JudgeMotions(*judge, dataset, Filtered(dataset, captured))});
  }
  return scorer;
}

absl::StatusOr<report::MethodFigures> SampleScorer::Score(
    const std::string& row, const std::vector<SampledMotions>& answers) const {
  report::MethodFigures figures{row, /*captured=*/false, {}};
  AddDistances(*dataset_, JoinFolds(answers), &figures);
  absl::Status status = AddJudged(answers, &figures);
  if (!status.ok()) return status;
  return figures;
}

absl::Status SampleScorer::AddJudged(const std::vector<SampledMotions>& answers,
                                     report::MethodFigures* figures) const {
  std::vector<JudgedFold> captured, captured_filtered;
  for (const SampleFold& fold : folds_) {
    captured.push_back(fold.captured);
    captured_filtered.push_back(fold.captured_filtered);
  }
  const int classes = dataset_->class_count();
  const size_t count = answers.empty() ? 0 : answers.front().size();
  auto& by_metric = figures->by_metric;
  for (size_t n = 0; n < count; ++n) {
    const JudgedSet set = JudgeSet(*dataset_, folds_, answers, n);
    absl::StatusOr<double> plain = PooledFrechet(set.plain, captured);
    absl::StatusOr<double> filtered = PooledFrechet(set.filtered, captured_filtered);
    if (!plain.ok() || !filtered.ok()) return plain.ok() ? filtered.status() : plain.status();
    AddShare({*plain}, count, &by_metric[report::kPooledFrechet]);
    AddShare({*filtered}, count, &by_metric[report::kFilteredFrechet]);
    AddShare(AccuracyByClass(set.plain, classes), count, &by_metric[report::kAccuracy]);
    AddShare(DiversityByClass(set.plain, classes), count, &by_metric[report::kDiversity]);
    AddShare(DiversityByClass(set.filtered, classes), count,
             &by_metric[report::kFilteredDiversity]);
  }
  return absl::OkStatus();
}

absl::StatusOr<report::MethodFigures> SampleScorer::ScoreCaptured() const {
  std::vector<SampledMotions> captured;
  for (const SampleFold& fold : folds_) {
    captured.push_back({metrics::CapturedMotions(*dataset_, fold.split.test)});
  }
  absl::StatusOr<report::MethodFigures> figures = Score("captured", captured);
  if (figures.ok()) figures->captured = true;
  return figures;
}

std::vector<std::pair<std::string, std::string>> SampleScorer::JudgeSettings() const {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const SampleFold& fold : folds_) {
    settings.emplace_back(absl::StrCat("judge without ", fold.subject, ", SHA-256"),
                          fold.judge.front().hash());
  }
  return settings;
}

}  // namespace duet::evaluation::program
