#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "model/base/status_macros.h"
#include "model/evaluation/baselines/baselines.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/report/metric_tables.h"

namespace duet::evaluation::program {
namespace {

// Value of --baselines for only the models' rows.
constexpr char kNoBaseline[] = "none";

struct FoldsFlags : ExperimentFlags {
  std::vector<std::string> baselines = {"class_mean", "frozen_first_frame"};
  std::vector<std::string> metrics = {"afd", "afd_squared"};
  bool printed = false;
};

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Scores one answer to each leader of every fold: every row in the same folds with the same judges.
class Scorer {
 public:
  static absl::StatusOr<Scorer> Create(const Experiment& experiment, bool judges) {
    Scorer scorer(experiment);
    if (judges) {
      DUET_TRY(scorer.judges_, TrainJudges(experiment.dataset, experiment.folds));
    }
    scorer.judged_captured_ =
        JudgeFolds(scorer.judges_, experiment.dataset, CapturedAnswers(experiment));
    return scorer;
  }

  report::MethodFigures Score(const std::string& row, const FoldAnswers& answers) const {
    const dataset::Dataset& dataset = experiment_->dataset;
    const int classes = dataset.class_count();
    report::MethodFigures figures{row, /*captured=*/false, ScoreByClass(dataset, Pool(answers))};
    if (judges_.empty()) return figures;
    const std::vector<metrics::JudgedFold> made = JudgeFolds(judges_, dataset, answers);
    figures.by_metric[report::kFrechet] = FrechetByClass(made, judged_captured_, classes);
    figures.by_metric[report::kAccuracy] = AccuracyByClass(made, classes);
    figures.by_metric[report::kDiversity] = DiversityByClass(made, classes);
    return figures;
  }

 private:
  explicit Scorer(const Experiment& experiment) : experiment_(&experiment) {}

  const Experiment* experiment_;
  std::vector<judge::MotionClassifier> judges_;  // [folds], or empty
  std::vector<metrics::JudgedFold> judged_captured_;
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
    rows.push_back(scorer.Score(name, answers));
  }
  for (const FoldModel& model : experiment.models) {
    for (const std::string& start : flags.starts) {
      Asked once;
      once.start = start;
      const auto answers = AnswerFolds(experiment, model, once);
      // A model without a start input has only one row.
      if (absl::IsFailedPrecondition(answers.status()) && start != "none") {
        std::cerr << model.name << " with " << start << ": left out: " << answers.status().message()
                  << "\n";
        continue;
      }
      DUET_RETURN_IF_ERROR(answers.status());
      rows.push_back(scorer.Score(model.name + StartSuffix(start), answers->front()));
    }
  }
  rows.push_back(scorer.Score("captured", CapturedAnswers(experiment)));
  rows.back().captured = true;
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
    report::Table& table =
        section.tables.emplace_back(MetricTable(style, experiment.dataset.classes, rows));
    const bool distance = style.name == "afd" || style.name == "afd_squared";
    if (flags.printed && distance) AddPrintedRows(report::PaperAfdSbu(), &table);
    if (flags.printed && style.name == report::kFrechet) {
      AddPrintedRows(report::PaperFidSbu(), &table);
    }
  }
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
  command->add_flag("--printed", flags->printed, "add the rows that the paper prints");
  return [flags] { return RunFolds(*flags); };
}

}  // namespace duet::evaluation::program
