#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/evaluation/experiments/sampled_answers.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/model_flags.h"
#include "model/evaluation/program/named_runs.h"
#include "model/evaluation/program/sample_scorer.h"
#include "model/evaluation/report/result_section.h"
#include "model/evaluation/report/sample_tables.h"

namespace duet::evaluation::program {
namespace {

struct Arguments {
  std::string data;
  ModelChoice models;
  std::vector<std::string> starts = {"none", "pose"};
  std::vector<std::string> subjects;
  experiments::AskedSamples asked;
  std::string out;
  std::string id = "14_samples";
  std::string title = "Many answers to one leader";
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

absl::StatusOr<std::vector<report::MethodFigures>> Rows(const dataset::Dataset& dataset,
                                                        const SampleScorer& scorer,
                                                        const std::vector<FoldModel>& models,
                                                        const Arguments& arguments) {
  std::vector<report::MethodFigures> rows;
  absl::StatusOr<report::MethodFigures> captured = scorer.ScoreCaptured();
  if (!captured.ok()) return captured.status();
  rows.push_back(*std::move(captured));
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

report::ResultSection MakeSection(const dataset::Dataset& dataset,
                                  const std::vector<std::string>& subjects,
                                  const Arguments& arguments, const SampleScorer& scorer) {
  report::ResultSection section;
  section.id = arguments.id;
  section.title = arguments.title;
  section.text = {
      "A model that samples answers every leader of every left-out subject several times, each "
      "with a seed of its own; one that does not answers once. The average frame distance rewards "
      "the mean of what may happen, so three are read side by side: of one answer, of the mean of "
      "all answers, and of the best. Speed, range, diversity and lean are to be near the captured "
      "followers' row, neither below nor above it. +pose: told the follower's first pose."};
  if (arguments.models.one_for_all()) section.text.push_back(kOneForAll);
  section.settings = {
      {"data", absl::StrCat(dataset.name, ", ", dataset.sequences.size(), " sequences")},
      {"left out in turn", absl::StrJoin(subjects, ", ")},
      {"answers to a leader", absl::StrCat(arguments.asked.samples)},
      {"variety", absl::StrCat(arguments.asked.variety)},
      {"seed", absl::StrCat(arguments.asked.seed)},
      {"models' answers", arguments.models.as_served ? "as served" : "the network's own"}};
  for (auto& setting : scorer.JudgeSettings()) section.settings.push_back(std::move(setting));
  section.command =
      absl::StrCat("duet-eval samples --data DIR", ModelWords(arguments.models), " --starts ",
                   absl::StrJoin(arguments.starts, ","), " --subjects ",
                   absl::StrJoin(subjects, ","), " --samples ", arguments.asked.samples,
                   " --variety ", arguments.asked.variety, " --seed ", arguments.asked.seed);
  section.date = report::Today();
  return section;
}

absl::Status Run(const Arguments& arguments) {
  absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(arguments.data);
  if (!dataset.ok()) return dataset.status();
  absl::StatusOr<std::vector<std::string>> subjects = FoldSubjects(*dataset, arguments.subjects);
  if (!subjects.ok()) return subjects.status();
  absl::StatusOr<std::vector<FoldModel>> models = OpenModels(arguments.models);
  if (!models.ok()) return models.status();
  absl::StatusOr<SampleScorer> scorer = SampleScorer::Create(*dataset, *subjects);
  if (!scorer.ok()) return scorer.status();
  absl::StatusOr<std::vector<report::MethodFigures>> rows =
      Rows(*dataset, *scorer, *models, arguments);
  if (!rows.ok()) return rows.status();
  report::ResultSection section = MakeSection(*dataset, *subjects, arguments, *scorer);
  section.tables = {report::SampleSummary(*rows)};
  report::Table spread = report::SampleSpread(*rows);
  if (!spread.rows.empty()) section.tables.push_back(std::move(spread));
  for (report::Table& table : report::SampleTables(dataset->classes, *rows)) {
    section.tables.push_back(std::move(table));
  }
  for (const report::Table& table : section.tables) std::cout << ToPlainText(table) << "\n";
  return arguments.out.empty() ? absl::OkStatus() : WriteSection(section, arguments.out);
}

}  // namespace

void AddSamplesCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app->add_subcommand("samples", "Figures of many answers to each leader");
  command->add_option("--data", arguments->data, "folder of captures (docs/datasets.md)")
      ->required();
  AddModelFlags(ModelNeeded::kYes, &arguments->models, command);
  AddStartsFlag(&arguments->starts, command);
  AddSamplingFlags(&arguments->asked, command);
  command
      ->add_option("--samples", arguments->asked.samples,
                   "answers to each leader by a model that samples")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--subjects", arguments->subjects, "folds; default: every subject")
      ->delimiter(',');
  command->add_option("--out", arguments->out, "folder of results, for duet-eval report");
  command->add_option("--id", arguments->id, "of the section")->capture_default_str();
  command->add_option("--title", arguments->title, "of the section")->capture_default_str();
  command->callback([arguments, chosen] { *chosen = [arguments] { return Run(*arguments); }; });
}

}  // namespace duet::evaluation::program
