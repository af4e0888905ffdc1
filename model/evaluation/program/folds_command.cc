#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/evaluation/baselines/baselines.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/fold_scorer.h"
#include "model/evaluation/report/metric_tables.h"

namespace duet::evaluation::program {
namespace {

// Value of --baselines for only the models' rows.
constexpr char kNoBaseline[] = "none";

struct FoldsArguments : ExperimentFlags {
  std::vector<std::string> baselines = {"class_mean", "frozen_first_frame"};
  std::vector<std::string> metrics = {"afd", "afd_squared"};
  std::vector<std::string> printed;
};

// Scores one answer to each leader of every fold. `answer` returns those of a fold.
template <typename Answer>
absl::StatusOr<report::MethodFigures> Score(const FoldScorer& scorer, const std::string& row,
                                            const Answer& answer) {
  OneAnswerEach answers;
  for (const Fold& fold : scorer.folds()) {
    DUET_TRY(answers.emplace_back(), answer(fold));
    std::cerr << absl::StrCat(row, " without ", fold.subject, ": ", answers.back().size(),
                              " leaders\n");
  }
  return scorer.Score(row, answers);
}

using Motions = absl::StatusOr<std::vector<metrics::ScoredMotion>>;

absl::StatusOr<report::MethodFigures> ScoreBaseline(const dataset::Dataset& dataset,
                                                    const FoldScorer& scorer,
                                                    const std::string& name) {
  return Score(scorer, name, [&](const Fold& fold) -> Motions {
    DUET_TRY(const std::unique_ptr<baselines::Method> method, baselines::MakeBaseline(name));
    return RunFold(dataset, fold.split, method.get());
  });
}

absl::StatusOr<report::MethodFigures> ScoreModel(const dataset::Dataset& dataset,
                                                 const FoldScorer& scorer, const FoldModel& model,
                                                 const std::string& start) {
  experiments::AskedSamples once;
  once.samples = 1;
  return Score(scorer, model.name + StartSuffix(ParseStart(start)),
               [&](const Fold& fold) -> Motions {
                 DUET_TRY(metrics::SampledMotions answers,
                          Answers(dataset, model, fold, fold.split.test, start, once));
                 return std::move(answers.front());
               });
}

absl::StatusOr<std::vector<report::MethodFigures>> Rows(const Experiment& experiment,
                                                        const FoldScorer& scorer,
                                                        const FoldsArguments& arguments) {
  std::vector<report::MethodFigures> rows;
  for (const std::string& name : arguments.baselines) {
    if (name == kNoBaseline) continue;
    DUET_TRY(rows.emplace_back(), ScoreBaseline(experiment.dataset, scorer, name));
  }
  for (const FoldModel& model : experiment.models) {
    for (const std::string& name : arguments.starts) {
      auto row = ScoreModel(experiment.dataset, scorer, model, name);
      // A model without a start input has only one row.
      if (absl::IsFailedPrecondition(row.status()) && name != StartNames().front()) {
        std::cerr << model.name << " with " << name << ": left out: " << row.status().message()
                  << "\n";
        continue;
      }
      DUET_TRY(rows.emplace_back(), std::move(row));
    }
  }
  DUET_TRY(rows.emplace_back(), scorer.ScoreCaptured());
  return rows;
}

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<report::Table> Tables(const dataset::Dataset& dataset, const FoldsArguments& arguments,
                                  const std::vector<report::MethodFigures>& rows) {
  std::vector<report::Table> tables;
  for (const report::MetricStyle& style : report::MetricStyles()) {
    if (!Contains(arguments.metrics, style.name)) continue;
    tables.push_back(MetricTable(style, dataset.classes, rows));
    const bool frame_distance = style.name == "afd" || style.name == "afd_squared";
    if (frame_distance && Contains(arguments.printed, "afd")) {
      AddPrintedRows(report::PaperAfdSbu(), &tables.back());
    }
    if (style.name == report::kFrechet && Contains(arguments.printed, "fid")) {
      AddPrintedRows(report::PaperFidSbu(), &tables.back());
    }
  }
  return tables;
}

bool NeedsJudge(const std::vector<std::string>& metrics) {
  const auto& styles = report::MetricStyles();
  return std::any_of(styles.begin(), styles.end(), [&](const report::MetricStyle& style) {
    return style.judged && Contains(metrics, style.name);
  });
}

absl::Status RunFolds(const FoldsArguments& arguments) {
  DUET_TRY(Experiment experiment, OpenExperiment(arguments));
  DUET_TRY(FoldScorer scorer,
           FoldScorer::Create(experiment.dataset, experiment.folds,
                              NeedsJudge(arguments.metrics) ? FoldScorer::Judging::kPlain
                                                            : FoldScorer::Judging::kNone));
  DUET_TRY(std::vector<report::MethodFigures> rows, Rows(experiment, scorer, arguments));
  report::ResultSection section = BeginExperiment(
      arguments, experiment,
      "Each subject is left out in turn: a method learns from the sequences without that subject "
      "and answers the leaders of the others. Figures are means over the answers of all folds. The "
      "suffix of a row names the input about the follower's first frame: none, the position of its "
      "root (+root) or its pose (+pose).");
  for (auto& setting : scorer.JudgeSettings()) section.settings.push_back(std::move(setting));
  section.tables = Tables(experiment.dataset, arguments, rows);
  for (const std::string& text : section.text) std::cout << text << "\n";
  std::cout << "\n";
  return FinishSection(arguments.section, section);
}

}  // namespace

void AddFoldsCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] = AddCommand(
      "folds", "Figures of models and baselines, leaving one subject out", RunFolds, app, chosen);
  arguments->starts = StartNames();
  AddExperimentFlags("10_folds", "Leave one subject out", arguments, command);
  AddModelFlags(ModelNeeded::kNo, &arguments->models, command);
  AddStartsFlag(&arguments->starts, command);
  std::vector<std::string> baselines = baselines::BaselineNames();
  baselines.push_back(kNoBaseline);
  AddNames("--baselines", &arguments->baselines, baselines, "rows of baselines; none: no such row",
           command);
  std::vector<std::string> metrics;
  for (const report::MetricStyle& style : report::MetricStyles()) metrics.push_back(style.name);
  AddNames("--metrics", &arguments->metrics, metrics, "tables to print", command);
  command->add_option("--printed", arguments->printed, "add the paper's rows: afd, fid")
      ->delimiter(',')
      ->check(CLI::IsMember({"afd", "fid"}));
}

}  // namespace duet::evaluation::program
