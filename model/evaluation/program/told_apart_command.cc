#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "model/evaluation/experiments/sampled_answers.h"
#include "model/evaluation/experiments/told_apart.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/fold_judge.h"
#include "model/evaluation/program/model_flags.h"
#include "model/evaluation/program/named_runs.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::program {
namespace {

struct Arguments {
  ExperimentFlags flags;
  std::vector<std::string> starts = {"none", "pose"};
  std::vector<uint64_t> seeds = {1, 2, 3};
  experiments::AskedSamples asked;
};

// One model's balanced accuracies. Shapes: [classifier seeds][folds].
using Accuracies = std::vector<std::vector<double>>;

absl::Status AddFold(const dataset::Dataset& dataset, const FoldModel& model,
                     const std::string& subject, experiments::StartGiven start,
                     const Arguments& arguments, Accuracies* accuracies) {
  absl::StatusOr<dataset::Split> split = LeaveSubjectOut(dataset, subject);
  if (!split.ok()) return split.status();
  absl::StatusOr<std::shared_ptr<const engine::Synthesizer>> synthesizer = model.load(subject);
  if (!synthesizer.ok()) return synthesizer.status();
  experiments::AskedSamples asked = arguments.asked;
  asked.samples = 1;
  absl::StatusOr<metrics::SampledMotions> training =
      AnswerWithSamples(**synthesizer, dataset, split->train, start, asked);
  if (!training.ok()) return training.status();
  absl::StatusOr<metrics::SampledMotions> test =
      AnswerWithSamples(**synthesizer, dataset, split->test, start, asked);
  if (!test.ok()) return test.status();
  for (size_t i = 0; i < arguments.seeds.size(); ++i) {
    absl::StatusOr<double> accuracy =
        experiments::ToldApart(dataset, training->front(), test->front(),
                               experiments::ToldApartOptions(arguments.seeds[i]));
    if (!accuracy.ok()) return accuracy.status();
    std::cerr << absl::StrFormat("%s%s without %s, classifier %d: %.3f\n", model.name,
                                 StartSuffix(start), subject, arguments.seeds[i], *accuracy);
    (*accuracies)[i].push_back(*accuracy);
  }
  return absl::OkStatus();
}

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// A column per fold, their mean, and the deviation (n - 1) of that mean over the classifiers'
// seeds.
report::TableRow Row(const std::string& name, const Accuracies& accuracies) {
  report::TableRow row = {name, {}};
  const size_t folds = accuracies.front().size();
  for (size_t fold = 0; fold < folds; ++fold) {
    std::vector<double> of_seeds;
    for (const std::vector<double>& of_folds : accuracies) of_seeds.push_back(of_folds[fold]);
    row.values.push_back(Mean(of_seeds));
  }
  std::vector<double> means;
  for (const std::vector<double>& of_folds : accuracies) means.push_back(Mean(of_folds));
  const double mean = Mean(means);
  double squares = 0;
  for (const double value : means) squares += (value - mean) * (value - mean);
  row.values.push_back(mean);
  row.values.push_back(means.size() < 2
                           ? std::numeric_limits<double>::quiet_NaN()
                           : std::sqrt(squares / static_cast<double>(means.size() - 1)));
  return row;
}

absl::StatusOr<report::Table> Measure(const dataset::Dataset& dataset,
                                      const std::vector<FoldModel>& models,
                                      const std::vector<std::string>& subjects,
                                      const Arguments& arguments) {
  report::Table table;
  table.title = "Balanced accuracy of telling synthesised from captured pairs";
  table.columns = subjects;
  table.columns.insert(table.columns.end(), {"mean", "spread"});
  table.decimals = 3;
  table.notes = {
      "0.5: cannot be told apart; 1: always. A column is a left-out person; spread: the standard "
      "deviation of the mean over the classifiers' seeds."};
  for (const std::string& name : arguments.starts) {
    const experiments::StartGiven start = ParseStart(name);
    for (const FoldModel& model : models) {
      Accuracies accuracies(arguments.seeds.size());
      for (const std::string& subject : subjects) {
        absl::Status status = AddFold(dataset, model, subject, start, arguments, &accuracies);
        if (!status.ok()) return status;
      }
      table.rows.push_back(Row(model.name + StartSuffix(start), accuracies));
    }
  }
  return table;
}

report::ResultSection MakeSection(const Experiment& experiment, const Arguments& arguments) {
  report::ResultSection section = BeginExperiment(
      arguments.flags, experiment,
      "A fresh classifier that sees leader and follower learns to tell a fold's answers to its "
      "training leaders from the captured pairs of the same people, and is tested on the left-out "
      "person: on that fold's answers to leaders never seen, and on the captured pairs. Both sides "
      "go through the same Gaussian of 0.1 s, so that a capture's noise gives nothing away.");
  section.settings.emplace_back("classifiers (seeds)", absl::StrJoin(arguments.seeds, ", "));
  section.settings.emplace_back("variety", absl::StrCat(arguments.asked.variety));
  section.settings.emplace_back("seed of the answers", absl::StrCat(arguments.asked.seed));
  return section;
}

absl::Status Run(const Arguments& arguments) {
  absl::StatusOr<Experiment> experiment = OpenExperiment(arguments.flags);
  if (!experiment.ok()) return experiment.status();
  const dataset::Dataset& dataset = experiment->dataset;
  report::ResultSection section = MakeSection(*experiment, arguments);
  absl::StatusOr<report::Table> table =
      Measure(dataset, experiment->models, experiment->subjects, arguments);
  if (!table.ok()) return table.status();
  section.tables = {*std::move(table)};
  return FinishSection(arguments.flags.section, section);
}

}  // namespace

void AddToldApartCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app->add_subcommand("told-apart", "How well a classifier tells answers from captured pairs");
  AddExperimentFlags("17_told_apart", "Told apart from captured pairs", &arguments->flags, command);
  AddModelFlags(ModelNeeded::kYes, &arguments->flags.models, command);
  AddStartsFlag(&arguments->starts, command);
  AddSamplingFlags(&arguments->asked, command);
  command->add_option("--seeds", arguments->seeds, "of the classifiers, one for each")
      ->delimiter(',')
      ->capture_default_str();
  RunWhenNamed(command, arguments, Run, chosen);
}

}  // namespace duet::evaluation::program
