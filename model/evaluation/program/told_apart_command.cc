#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"
#include "model/evaluation/experiments/told_apart.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::program {
namespace {

struct ToldApartArguments : ExperimentFlags {
  std::vector<uint64_t> seeds = {1, 2, 3};
};

// One model's balanced accuracies. Shapes: [classifier seeds][folds].
using Accuracies = std::vector<std::vector<double>>;

absl::Status AddFold(const dataset::Dataset& dataset, const FoldModel& model, const Fold& fold,
                     const std::string& start, const ToldApartArguments& arguments,
                     Accuracies* accuracies) {
  const experiments::AskedSamples& asked = arguments.asked;
  DUET_TRY(auto training, Answers(dataset, model, fold, fold.split.train, start, asked));
  DUET_TRY(auto test, Answers(dataset, model, fold, fold.split.test, start, asked));
  for (size_t i = 0; i < arguments.seeds.size(); ++i) {
    DUET_TRY(double accuracy,
             experiments::ToldApart(dataset, training.front(), test.front(),
                                    experiments::ToldApartOptions(arguments.seeds[i])));
    std::cerr << absl::StrFormat("%s%s without %s, classifier %d: %.3f\n", model.name,
                                 StartSuffix(ParseStart(start)), fold.subject, arguments.seeds[i],
                                 accuracy);
    (*accuracies)[i].push_back(accuracy);
  }
  return absl::OkStatus();
}

absl::StatusOr<report::Table> Measure(const Experiment& experiment,
                                      const ToldApartArguments& arguments) {
  report::Table table{"Balanced accuracy of telling synthesised from captured pairs"};
  for (const Fold& fold : experiment.folds) table.columns.push_back(fold.subject);
  table.columns.insert(table.columns.end(), {"mean", "spread"});
  table.decimals = 3;
  table.notes = {
      "0.5: cannot be told apart; 1: always. A column is a left-out person; spread: the standard "
      "deviation of the mean over the classifiers' seeds."};
  for (const std::string& start : arguments.starts) {
    for (const FoldModel& model : experiment.models) {
      Accuracies accuracies(arguments.seeds.size());
      for (const Fold& fold : experiment.folds) {
        DUET_RETURN_IF_ERROR(
            AddFold(experiment.dataset, model, fold, start, arguments, &accuracies));
      }
      std::vector<double> values = report::ColumnMeans(accuracies), means;
      for (const std::vector<double>& of_folds : accuracies) means.push_back(base::Mean(of_folds));
      const base::MeanAndDeviation of_seeds = base::Summarise(means);
      values.insert(values.end(), {of_seeds.mean, of_seeds.deviation});
      table.rows.push_back({model.name + StartSuffix(ParseStart(start)), std::move(values)});
    }
  }
  return table;
}

absl::Status RunToldApart(const ToldApartArguments& arguments) {
  DUET_TRY(Experiment experiment, OpenExperiment(arguments));
  report::ResultSection section = BeginAnswers(
      arguments, experiment,
      "A fresh classifier that sees leader and follower learns to tell a fold's answers to its "
      "training leaders from the captured pairs of the same people, and is tested on the left-out "
      "person: on that fold's answers to leaders never seen, and on the captured pairs. Both sides "
      "go through the same Gaussian of 0.1 s, so that a capture's noise gives nothing away.");
  section.settings.emplace_back("classifiers (seeds)", absl::StrJoin(arguments.seeds, ", "));
  DUET_TRY(section.tables.emplace_back(), Measure(experiment, arguments));
  return FinishSection(arguments.section, section);
}

}  // namespace

void AddToldApartCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] =
      AddCommand("told-apart", "How well a classifier distinguishes answers from captured pairs",
                 RunToldApart, app, chosen);
  arguments->asked.samples = 1;
  AddAnswersFlags("17_told_apart", "Told apart from captured pairs", arguments, command);
  AddOption("--seeds", &arguments->seeds, "seeds; one classifier per seed", command)
      ->delimiter(',');
}

}  // namespace duet::evaluation::program
