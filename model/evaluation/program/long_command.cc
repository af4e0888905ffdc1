#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/evaluation/experiments/long_clips.h"
#include "model/evaluation/experiments/long_leaders.h"
#include "model/evaluation/experiments/sampled_answers.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/fold_judge.h"
#include "model/evaluation/program/model_flags.h"
#include "model/evaluation/program/named_runs.h"
#include "model/evaluation/report/long_tables.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::program {
namespace {

struct Arguments {
  std::string data;
  ModelChoice models;
  std::vector<std::string> starts = {"none", "pose"};
  std::vector<std::string> subjects;
  std::vector<double> seconds = {60, 600};
  experiments::AskedSamples asked;
  std::string out;
  std::string id = "16_long";
  std::string title = "Clips of a minute and of ten";
};

// The answers of one fold's model to every leader in every class.
absl::Status AddFold(const dataset::Dataset& dataset, const FoldModel& model,
                     const std::string& subject, double seconds, experiments::StartGiven start,
                     const Arguments& arguments, std::vector<experiments::LongClipRow>* rows) {
  absl::StatusOr<dataset::Split> split = LeaveSubjectOut(dataset, subject);
  if (!split.ok()) return split.status();
  absl::StatusOr<std::shared_ptr<const engine::Synthesizer>> synthesizer = model.load(subject);
  if (!synthesizer.ok()) return synthesizer.status();
  absl::Status fits = CheckModelTakes((*synthesizer)->description(), dataset, start);
  if (!fits.ok()) return fits;
  std::vector<experiments::LongLeader> leaders;
  for (int c = 0; c < dataset.class_count(); ++c) {
    for (auto& leader : experiments::MakeLongLeaders(dataset, split->test, c, seconds)) {
      leaders.push_back(std::move(leader));
    }
  }
  std::vector<experiments::LabelledLeader> asked;
  for (const experiments::LongLeader& leader : leaders) {
    std::vector<float> labels(dataset.classes.size());
    labels[static_cast<size_t>(leader.sequence.interaction_class)] = 1;
    asked.push_back({&leader.sequence,
                     std::move(labels),
                     {arguments.asked.seed + asked.size(), arguments.asked.variety}});
  }
  absl::StatusOr<std::vector<motion::Poses>> followers =
      SynthesizeSequences(**synthesizer, asked, start);
  if (!followers.ok()) return followers.status();
  for (size_t i = 0; i < leaders.size(); ++i) {
    const dataset::Sequence& sequence = leaders[i].sequence;
    rows->push_back({model.name, leaders[i].name, sequence.interaction_class,
                     experiments::MeasureLongClip(dataset.skeleton, sequence.pair.leader.poses,
                                                  (*followers)[i], dataset.frame_rate_hz)});
  }
  std::cerr << absl::StrCat(model.name, StartSuffix(start), " without ", subject, ": ",
                            leaders.size(), " leaders of ", seconds, " s\n");
  return absl::OkStatus();
}

absl::StatusOr<std::vector<report::Table>> Tables(const dataset::Dataset& dataset,
                                                  const std::vector<FoldModel>& models,
                                                  const std::vector<std::string>& subjects,
                                                  const Arguments& arguments) {
  std::vector<report::Table> tables;
  for (const double seconds : arguments.seconds) {
    for (const std::string& start : arguments.starts) {
      std::vector<experiments::LongClipRow> rows;
      for (const FoldModel& model : models) {
        for (const std::string& subject : subjects) {
          absl::Status status =
              AddFold(dataset, model, subject, seconds, ParseStart(start), arguments, &rows);
          if (!status.ok()) return status;
        }
      }
      const std::string what = absl::StrCat(seconds, " s, told ", start);
      for (report::Table& table : report::LongTables(what, dataset.classes, rows)) {
        tables.push_back(std::move(table));
      }
    }
  }
  return tables;
}

report::ResultSection MakeSection(const dataset::Dataset& dataset,
                                  const std::vector<std::string>& subjects,
                                  const Arguments& arguments) {
  report::ResultSection section;
  section.id = arguments.id;
  section.title = arguments.title;
  section.text = {
      "Leaders that last, each answered in every class, by windows of which each goes on from the "
      "one before. Four are made by formulas and unlike anything in the captures: one stands and "
      "sways, one walks an eight, one dances, one sits down and gets up. \"captured\" are the "
      "class's clips of the left-out person one after the other. A figure is the worst over the "
      "folds."};
  if (arguments.models.one_for_all()) section.text.push_back(kOneForAll);
  section.settings = {
      {"data", absl::StrCat(dataset.name, ", ", dataset.sequences.size(), " sequences")},
      {"left out in turn", absl::StrJoin(subjects, ", ")},
      {"variety", absl::StrCat(arguments.asked.variety)},
      {"seed", absl::StrCat(arguments.asked.seed)},
      {"models' answers", arguments.models.as_served ? "as served" : "the network's own"}};
  section.command = absl::StrCat("duet-eval long --data DIR", ModelWords(arguments.models),
                                 " --seconds ", absl::StrJoin(arguments.seconds, ","), " --starts ",
                                 absl::StrJoin(arguments.starts, ","), " --subjects ",
                                 absl::StrJoin(subjects, ","), " --variety ",
                                 arguments.asked.variety, " --seed ", arguments.asked.seed);
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
  report::ResultSection section = MakeSection(*dataset, *subjects, arguments);
  absl::StatusOr<std::vector<report::Table>> tables =
      Tables(*dataset, *models, *subjects, arguments);
  if (!tables.ok()) return tables.status();
  section.tables = *std::move(tables);
  for (const report::Table& table : section.tables) std::cout << ToPlainText(table) << "\n";
  return arguments.out.empty() ? absl::OkStatus() : WriteSection(section, arguments.out);
}

}  // namespace

void AddLongCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app->add_subcommand("long", "Whether followers of long clips stand, near their leaders");
  command->add_option("--data", arguments->data, "folder of captures (docs/datasets.md)")
      ->required();
  AddModelFlags(ModelNeeded::kYes, &arguments->models, command);
  AddStartsFlag(&arguments->starts, command);
  AddSamplingFlags(&arguments->asked, command);
  command->add_option("--seconds", arguments->seconds, "how long leaders last")
      ->delimiter(',')
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  command->add_option("--subjects", arguments->subjects, "folds; default: every subject")
      ->delimiter(',');
  command->add_option("--out", arguments->out, "folder of results, for duet-eval report");
  command->add_option("--id", arguments->id, "of the section")->capture_default_str();
  command->add_option("--title", arguments->title, "of the section")->capture_default_str();
  command->callback([arguments, chosen] { *chosen = [arguments] { return Run(*arguments); }; });
}

}  // namespace duet::evaluation::program
