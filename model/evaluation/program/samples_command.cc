#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/evaluation/baselines/other_people.h"
#include "model/evaluation/experiments/sampled_answers.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/model_flags.h"
#include "model/evaluation/program/named_runs.h"
#include "model/evaluation/program/sample_scorer.h"
#include "model/evaluation/report/result_section.h"
#include "model/evaluation/report/sample_tables.h"

namespace duet::evaluation::program {
namespace {

struct Arguments {
  ExperimentFlags flags;
  std::vector<std::string> starts = {"none", "pose"};
  experiments::AskedSamples asked;
};

absl::StatusOr<report::MethodFigures> ScoreModel(const dataset::Dataset& dataset,
                                                 const SampleScorer& scorer, const FoldModel& model,
                                                 experiments::StartGiven start,
                                                 const experiments::AskedSamples& asked) {
  const std::string row = model.name + StartSuffix(start);
  std::vector<metrics::SampledMotions> answers;
  for (const SampleFold& fold : scorer.folds()) {
    absl::StatusOr<std::shared_ptr<const engine::Synthesizer>> synthesizer =
        model.load(fold.subject);
    if (!synthesizer.ok()) return synthesizer.status();
    absl::StatusOr<metrics::SampledMotions> of_fold =
        AnswerWithSamples(**synthesizer, dataset, fold.split.test, start, asked);
    if (!of_fold.ok()) return of_fold.status();
    std::cerr << absl::StrCat(row, " without ", fold.subject, ": ", fold.split.test.size(),
                              " leaders, ", of_fold->size(), " answers each\n");
    answers.push_back(*std::move(of_fold));
  }
  return scorer.Score(row, answers);
}

// The same figures for captured people who answer another leader of the class.
absl::StatusOr<report::MethodFigures> ScoreOtherPeople(const dataset::Dataset& dataset,
                                                       const SampleScorer& scorer,
                                                       const experiments::AskedSamples& asked) {
  std::vector<metrics::SampledMotions> answers;
  for (const SampleFold& fold : scorer.folds()) {
    metrics::SampledMotions of_fold(static_cast<size_t>(asked.samples));
    for (size_t n = 0; n < of_fold.size(); ++n) {
      absl::StatusOr<std::vector<motion::Poses>> followers = baselines::AnswerWithOtherPeople(
          dataset, fold.split.train, fold.split.test, asked.seed + n);
      if (!followers.ok()) return followers.status();
      auto follower = followers->begin();
      for (const int index : fold.split.test) {
        of_fold[n].push_back({index, std::move(*follower++)});
      }
    }
    answers.push_back(std::move(of_fold));
  }
  return scorer.Score("other people", answers);
}

absl::StatusOr<std::vector<report::MethodFigures>> Rows(const dataset::Dataset& dataset,
                                                        const SampleScorer& scorer,
                                                        const std::vector<FoldModel>& models,
                                                        const Arguments& arguments) {
  std::vector<report::MethodFigures> rows;
  absl::StatusOr<report::MethodFigures> captured = scorer.ScoreCaptured();
  if (!captured.ok()) return captured.status();
  rows.push_back(*std::move(captured));
  absl::StatusOr<report::MethodFigures> others = ScoreOtherPeople(dataset, scorer, arguments.asked);
  if (!others.ok()) return others.status();
  rows.push_back(*std::move(others));
  for (const std::string& start : arguments.starts) {
    for (const FoldModel& model : models) {
      absl::StatusOr<report::MethodFigures> row =
          ScoreModel(dataset, scorer, model, ParseStart(start), arguments.asked);
      if (!row.ok()) return row.status();
      rows.push_back(*std::move(row));
    }
  }
  return rows;
}

report::ResultSection MakeSection(const Experiment& experiment, const Arguments& arguments,
                                  const SampleScorer& scorer) {
  report::ResultSection section = BeginExperiment(
      arguments.flags, experiment,
      "A model that samples answers every leader of every left-out subject several times, each "
      "with a seed of its own; one that does not answers once. The average frame distance rewards "
      "the mean of what may happen, so three are read side by side: of one answer, of the mean of "
      "all answers, and of the best. Speed, range, diversity and lean are to be near the captured "
      "followers' row, neither below nor above it. +pose: told the follower's first pose. Other "
      "people: captured followers of training clips of the same class, drawn at random: real "
      "motion of people who answered another leader.");
  section.settings.emplace_back("answers to a leader", absl::StrCat(arguments.asked.samples));
  section.settings.emplace_back("variety", absl::StrCat(arguments.asked.variety));
  section.settings.emplace_back("seed", absl::StrCat(arguments.asked.seed));
  section.settings.emplace_back("direction of the partner",
                                arguments.asked.tell_direction ? "told" : "from the leader");
  for (auto& setting : scorer.JudgeSettings()) section.settings.push_back(std::move(setting));
  return section;
}

absl::Status Run(const Arguments& arguments) {
  absl::StatusOr<Experiment> experiment = OpenExperiment(arguments.flags);
  if (!experiment.ok()) return experiment.status();
  const dataset::Dataset& dataset = experiment->dataset;
  absl::StatusOr<SampleScorer> scorer = SampleScorer::Create(dataset, experiment->subjects);
  if (!scorer.ok()) return scorer.status();
  absl::StatusOr<std::vector<report::MethodFigures>> rows =
      Rows(dataset, *scorer, experiment->models, arguments);
  if (!rows.ok()) return rows.status();
  report::ResultSection section = MakeSection(*experiment, arguments, *scorer);
  section.tables = {report::SampleSummary(*rows)};
  report::Table spread = report::SampleSpread(*rows);
  if (!spread.rows.empty()) section.tables.push_back(std::move(spread));
  for (report::Table& table : report::SampleTables(dataset.classes, *rows)) {
    section.tables.push_back(std::move(table));
  }
  return FinishSection(arguments.flags.section, section);
}

}  // namespace

void AddSamplesCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app->add_subcommand("samples", "Figures of many answers to each leader");
  AddExperimentFlags("14_samples", "Many answers to one leader", &arguments->flags, command);
  AddModelFlags(ModelNeeded::kYes, &arguments->flags.models, command);
  AddStartsFlag(&arguments->starts, command);
  AddSamplingFlags(&arguments->asked, command);
  command
      ->add_option("--samples", arguments->asked.samples,
                   "answers to each leader by a model that samples")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("!--untold-direction", arguments->asked.tell_direction,
                    "leave where the partner is to the leader's motion");
  RunWhenNamed(command, arguments, Run, chosen);
}

}  // namespace duet::evaluation::program
