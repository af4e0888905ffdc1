#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "model/base/statistics.h"
#include "model/evaluation/experiments/told_apart.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/model_flags.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::program {
namespace {

struct Arguments {
  ExperimentFlags flags;
  std::vector<uint64_t> seeds = {1, 2, 3};
};

// One model's balanced accuracies. Shapes: [classifier seeds][folds].
using Accuracies = std::vector<std::vector<double>>;

absl::Status AddFold(const dataset::Dataset& dataset, const FoldModel& model, const Fold& fold,
                     const std::string& start, const Arguments& arguments, Accuracies* accuracies) {
  experiments::AskedSamples asked = arguments.flags.asked;
  asked.samples = 1;
  absl::StatusOr<metrics::SampledMotions> training =
      Answers(dataset, model, fold, fold.split.train, start, asked);
  if (!training.ok()) return training.status();
  absl::StatusOr<metrics::SampledMotions> test =
      Answers(dataset, model, fold, fold.split.test, start, asked);
  if (!test.ok()) return test.status();
  for (size_t i = 0; i < arguments.seeds.size(); ++i) {
    absl::StatusOr<double> accuracy =
        experiments::ToldApart(dataset, training->front(), test->front(),
                               experiments::ToldApartOptions(arguments.seeds[i]));
    if (!accuracy.ok()) return accuracy.status();
    std::cerr << absl::StrFormat("%s%s without %s, classifier %d: %.3f\n", model.name,
                                 StartSuffix(ParseStart(start)), fold.subject, arguments.seeds[i],
                                 *accuracy);
    (*accuracies)[i].push_back(*accuracy);
  }
  return absl::OkStatus();
}

// A column per fold, their mean, and the deviation of that mean over the classifiers' seeds.
report::TableRow Row(const std::string& name, const Accuracies& accuracies) {
  report::TableRow row = {name, {}};
  for (size_t fold = 0; fold < accuracies.front().size(); ++fold) {
    std::vector<double> of_seeds;
    for (const std::vector<double>& of_folds : accuracies) of_seeds.push_back(of_folds[fold]);
    row.values.push_back(base::Mean(of_seeds));
  }
  std::vector<double> means;
  for (const std::vector<double>& of_folds : accuracies) means.push_back(base::Mean(of_folds));
  const base::MeanAndDeviation of_seeds = base::Summarise(means);
  row.values.insert(row.values.end(), {of_seeds.mean, of_seeds.deviation});
  return row;
}

absl::StatusOr<report::Table> Measure(const Experiment& experiment, const Arguments& arguments) {
  report::Table table;
  table.title = "Balanced accuracy of telling synthesised from captured pairs";
  for (const Fold& fold : experiment.folds) table.columns.push_back(fold.subject);
  table.columns.insert(table.columns.end(), {"mean", "spread"});
  table.decimals = 3;
  table.notes = {
      "0.5: cannot be told apart; 1: always. A column is a left-out person; spread: the standard "
      "deviation of the mean over the classifiers' seeds."};
  for (const std::string& start : arguments.flags.starts) {
    for (const FoldModel& model : experiment.models) {
      Accuracies accuracies(arguments.seeds.size());
      for (const Fold& fold : experiment.folds) {
        absl::Status status =
            AddFold(experiment.dataset, model, fold, start, arguments, &accuracies);
        if (!status.ok()) return status;
      }
      table.rows.push_back(Row(model.name + StartSuffix(ParseStart(start)), accuracies));
    }
  }
  return table;
}

report::ResultSection MakeSection(const Experiment& experiment, const Arguments& arguments) {
  report::ResultSection section = BeginAnswers(
      arguments.flags, experiment,
      "A fresh classifier that sees leader and follower learns to tell a fold's answers to its "
      "training leaders from the captured pairs of the same people, and is tested on the left-out "
      "person: on that fold's answers to leaders never seen, and on the captured pairs. Both sides "
      "go through the same Gaussian of 0.1 s, so that a capture's noise gives nothing away.");
  section.settings.emplace_back("classifiers (seeds)", absl::StrJoin(arguments.seeds, ", "));
  return section;
}

absl::Status Run(const Arguments& arguments) {
  absl::StatusOr<Experiment> experiment = OpenExperiment(arguments.flags);
  if (!experiment.ok()) return experiment.status();
  report::ResultSection section = MakeSection(*experiment, arguments);
  absl::StatusOr<report::Table> table = Measure(*experiment, arguments);
  if (!table.ok()) return table.status();
  section.tables = {*std::move(table)};
  return FinishSection(arguments.flags.section, section);
}

}  // namespace

void AddToldApartCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app->add_subcommand(
      "told-apart", "How well a classifier distinguishes answers from captured pairs");
  AddAnswersFlags("17_told_apart", "Told apart from captured pairs", &arguments->flags, command);
  command->add_option("--seeds", arguments->seeds, "seeds; one classifier per seed")
      ->delimiter(',')
      ->capture_default_str();
  RunWhenNamed(command, arguments, Run, chosen);
}

}  // namespace duet::evaluation::program
