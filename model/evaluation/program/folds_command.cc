#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/evaluation/baselines/baselines.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/report/report.h"
#include "model/motion/filter.h"

namespace duet::evaluation::program {
namespace {

using metrics::JudgedFold;

// Value of --baselines for only the models' rows.
constexpr char kNoBaseline[] = "none";

struct FoldsFlags : ExperimentFlags {
  std::vector<std::string> baselines = {"class_mean", "frozen_first_frame"};
  std::vector<std::string> metrics = {"afd", "afd_squared"};
};

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// One answer to each test leader of each fold. Shapes: [folds][test].
using FoldAnswers = std::vector<std::vector<metrics::ScoredMotion>>;

FoldAnswers CapturedAnswers(const Experiment& experiment) {
  FoldAnswers captured;
  for (const Fold& fold : experiment.folds) {
    captured.push_back(metrics::CapturedMotions(experiment.dataset, fold.split.test));
  }
  return captured;
}

// The results of each fold's judge. Shapes: judges and answers [folds].
std::vector<metrics::JudgedFold> JudgeFolds(const std::vector<judge::MotionClassifier>& judges,
                                            const dataset::Dataset& dataset,
                                            const FoldAnswers& answers) {
  std::vector<metrics::JudgedFold> judged;
  for (size_t i = 0; i < judges.size(); ++i) {
    judged.push_back(judges[i].Judge(dataset, answers[i]));
  }
  return judged;
}

// A model's answers, each in the class of its sequence at weight 1. Shapes: returns [samples].
absl::StatusOr<std::vector<FoldAnswers>> AnswerFolds(const Experiment& experiment,
                                                     const FoldModel& model) {
  std::vector<FoldAnswers> sets;
  for (const Fold& fold : experiment.folds) {
    DUET_TRY(const SharedSynthesizer synthesizer, model.load(fold.subject));
    DUET_TRY(metrics::SampledMotions of_fold,
             AnswerWithSamples(*synthesizer, experiment.dataset, fold.split.test, model.asked));
    sets.resize(of_fold.size());
    for (size_t n = 0; n < sets.size(); ++n) sets[n].push_back(std::move(of_fold[n]));
    std::cerr << absl::StrCat(model.name, " without ", fold.subject, ": ", fold.split.test.size(),
                              " leaders, ", sets.size(), " answers each\n");
  }
  return sets;
}

FoldAnswers Filtered(const dataset::Dataset& dataset, FoldAnswers folds) {
  for (std::vector<metrics::ScoredMotion>& motions : folds) {
    for (metrics::ScoredMotion& motion : motions) {
      const double rate = SequenceOf(dataset, motion).pair.leader.frame_rate_hz;
      motion.follower = motion::WithoutNoise(motion.follower, rate);
    }
  }
  return folds;
}

// Adds values / count to sums, which may still be empty.
void AddShare(const std::vector<double>& values, size_t count, std::vector<double>* sums) {
  sums->resize(values.size());
  for (size_t i = 0; i < values.size(); ++i) (*sums)[i] += values[i] / static_cast<double>(count);
}

// Scores answers to the leaders of every fold: every row in the same folds with the same judges.
class Scorer {
 public:
  // `experiment` must outlive the scorer.
  static absl::StatusOr<Scorer> Create(const Experiment& experiment, bool judges) {
    Scorer scorer(experiment);
    if (!judges) return scorer;
    const dataset::Dataset& dataset = experiment.dataset;
    const FoldAnswers captured = CapturedAnswers(experiment);
    DUET_TRY(scorer.judges_, TrainJudges(dataset, experiment.folds));
    scorer.captured_ = JudgeFolds(scorer.judges_, dataset, captured);
    scorer.filtered_ = JudgeFolds(scorer.judges_, dataset, Filtered(dataset, captured));
    return scorer;
  }

  // Shapes: sets [samples], answers to all leaders each.
  report::MethodFigures Score(const std::string& row, const std::vector<FoldAnswers>& sets) const {
    const dataset::Dataset& dataset = experiment_.dataset;
    const int classes = dataset.class_count();
    metrics::SampledMotions answers;
    for (const FoldAnswers& set : sets) answers.push_back(Pool(set));
    report::MethodFigures figures{row, ScoreByClass(dataset, Pool(answers))};
    auto& by_metric = figures.by_metric;
    by_metric[report::kMeanAnswerAfd] = ScoreByClass(dataset, MeanAnswers(answers))["afd"];
    by_metric[report::kBestAnswerAfd] = ScoreByClass(dataset, BestAnswers(dataset, answers))["afd"];
    by_metric[report::kMultimodality] = MultimodalityByClass(dataset, answers);
    for (const FoldAnswers& set : sets) {
      if (judges_.empty()) break;
      const std::vector<JudgedFold> made = JudgeFolds(judges_, dataset, set),
                                    filtered = JudgeFolds(judges_, dataset, Filtered(dataset, set));
      const auto add = [&](const char* name, const std::vector<double>& values) {
        AddShare(values, sets.size(), &by_metric[name]);
      };
      add(report::kFrechet, FrechetByClass(made, captured_, classes));
      add(report::kPooledFrechet, {PooledFrechet(made, captured_)});
      add(report::kFilteredFrechet, {PooledFrechet(filtered, filtered_)});
      add(report::kAccuracy, AccuracyByClass(made, classes));
      add(report::kDiversity, DiversityByClass(made, classes));
      add(report::kFilteredDiversity, DiversityByClass(filtered, classes));
    }
    return figures;
  }

 private:
  explicit Scorer(const Experiment& experiment) : experiment_(experiment) {}

  const Experiment& experiment_;
  std::vector<judge::MotionClassifier> judges_;  // [folds], or empty
  std::vector<JudgedFold> captured_, filtered_;  // of the captured followers
};

absl::StatusOr<std::vector<report::MethodFigures>> Rows(const Experiment& experiment,
                                                        const FoldsFlags& flags) {
  const auto& styles = report::MetricStyles();
  const bool judged = std::any_of(styles.begin(), styles.end(), [&](const auto& style) {
    return style.judged && Contains(flags.metrics, style.name);
  });
  DUET_TRY(const Scorer scorer, Scorer::Create(experiment, judged));
  std::vector<report::MethodFigures> rows;
  for (const std::string& name : flags.baselines) {
    if (name == kNoBaseline) continue;
    FoldAnswers answers;
    for (const Fold& fold : experiment.folds) {
      DUET_TRY(answers.emplace_back(),
               baselines::RunBaseline(name, experiment.dataset, fold.split));
    }
    rows.push_back(scorer.Score(name, {answers}));
  }
  for (const FoldModel& model : experiment.models) {
    const auto answers = AnswerFolds(experiment, model);
    // A model without a start input has only one row.
    if (absl::IsFailedPrecondition(answers.status()) && model.asked.start != "none") {
      std::cerr << model.name << ": left out: " << answers.status().message() << "\n";
      continue;
    }
    DUET_RETURN_IF_ERROR(answers.status());
    rows.push_back(scorer.Score(model.name, *answers));
  }
  rows.push_back(scorer.Score(report::kCaptured, {CapturedAnswers(experiment)}));
  return rows;
}

absl::StatusOr<report::Section> RunFolds(const FoldsFlags& flags) {
  DUET_TRY(const Experiment experiment, OpenExperiment(flags));
  DUET_TRY(const std::vector<report::MethodFigures> rows, Rows(experiment, flags));
  report::Section section = BeginExperiment(
      flags, experiment,
      "Each subject is left out in turn: a method learns from the sequences without that subject "
      "and answers the leaders of the others. Figures are means over the answers of all folds. The "
      "suffix of a row names the input about the follower's first frame: none, the position of its "
      "root (+root) or its pose (+pose).");
  for (const report::MetricStyle& style : report::MetricStyles()) {
    if (!Contains(flags.metrics, style.name)) continue;
    section.tables.push_back(MetricTable(style, experiment.dataset.classes, rows));
  }
  return section;
}

absl::StatusOr<report::Section> RunSamples(const ExperimentFlags& flags) {
  DUET_TRY(const Experiment experiment, OpenExperiment(flags));
  DUET_TRY(const Scorer scorer, Scorer::Create(experiment, true));
  std::vector<report::MethodFigures> rows = {
      scorer.Score(report::kCaptured, {CapturedAnswers(experiment)})};
  std::vector<FoldAnswers> others(static_cast<size_t>(flags.asked.samples));
  for (size_t n = 0; n < others.size(); ++n) {
    for (const Fold& fold : experiment.folds) {
      DUET_TRY(others[n].emplace_back(), baselines::AnswerWithOtherPeople(
                                             experiment.dataset, fold.split, flags.asked.seed + n));
    }
  }
  rows.push_back(scorer.Score("other people", others));
  for (const FoldModel& model : experiment.models) {
    DUET_TRY(const std::vector<FoldAnswers> sets, AnswerFolds(experiment, model));
    rows.push_back(scorer.Score(model.name, sets));
  }
  report::Section section = BeginExperiment(
      flags, experiment,
      "A model that samples answers every leader of every left-out subject several times, each "
      "time with another seed; other models answer once. The average frame distance rewards the "
      "mean of all plausible motions, so the table gives it for one answer, for the mean of all "
      "answers and for the best. Speed, range, diversity and lean should be close to the captured "
      "followers' row, neither below nor above it. +pose: the input includes the follower's first "
      "pose. Other people: captured followers of training clips of the same class, drawn at "
      "random, who answered another leader.");
  section.tables = {report::SampleSummary(rows)};
  return section;
}

}  // namespace

Measure AddFoldsCommand(CLI::App* command) {
  const auto flags = std::make_shared<FoldsFlags>();
  flags->starts = {"none", "root", "pose"};
  AddExperimentFlags(flags.get(), command);
  AddModelFlags(flags.get(), command);
  AddStartsFlag(flags.get(), command);
  std::vector<std::string> baselines = baselines::BaselineNames();
  baselines.push_back(kNoBaseline);
  AddNames("--baselines", &flags->baselines, baselines, "rows of baselines; none: no such row",
           command);
  std::vector<std::string> metrics;
  for (const report::MetricStyle& style : report::MetricStyles()) metrics.push_back(style.name);
  AddNames("--metrics", &flags->metrics, metrics, "tables to print", command);
  return [flags] { return RunFolds(*flags); };
}

Measure AddSamplesCommand(CLI::App* command) {
  const auto flags = std::make_shared<ExperimentFlags>();
  flags->asked.samples = 10;
  AddAnswersFlags(flags.get(), command);
  return [flags] { return RunSamples(*flags); };
}

}  // namespace duet::evaluation::program
