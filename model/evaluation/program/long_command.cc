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
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/fold_judge.h"
#include "model/evaluation/program/model_flags.h"
#include "model/evaluation/program/named_runs.h"
#include "model/evaluation/report/long_tables.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::program {
namespace {

struct Arguments {
  ExperimentFlags flags;
  std::vector<std::string> starts = {"none", "pose"};
  std::vector<double> seconds = {60, 600};
  experiments::AskedSamples asked;
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

// The same figures for captured followers of the left-out people, clip by clip.
absl::Status AddCaptured(const dataset::Dataset& dataset, const std::string& subject,
                         std::vector<experiments::LongClipRow>* rows) {
  absl::StatusOr<dataset::Split> split = LeaveSubjectOut(dataset, subject);
  if (!split.ok()) return split.status();
  for (const int s : split->test) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(s)];
    rows->push_back(
        {"people", "clips as captured", sequence.interaction_class,
         experiments::MeasureLongClip(dataset.skeleton, sequence.pair.leader.poses,
                                      sequence.pair.follower.poses, dataset.frame_rate_hz)});
  }
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
      for (const std::string& subject : subjects) {
        absl::Status status = AddCaptured(dataset, subject, &rows);
        if (!status.ok()) return status;
      }
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

report::ResultSection MakeSection(const Experiment& experiment, const Arguments& arguments) {
  report::ResultSection section = BeginExperiment(
      arguments.flags, experiment,
      "Leaders that last, each answered in every class, by windows of which each goes on from the "
      "one before. Four are made by formulas and unlike anything in the captures: one stands and "
      "sways, one walks an eight, one dances, one sits down and gets up. \"captured\" are the "
      "class's clips of the left-out person one after the other. A figure is the worst over the "
      "folds. The first row, for comparison: the left-out people's own captured followers, clip by "
      "clip, a few seconds each.");
  section.settings.emplace_back("variety", absl::StrCat(arguments.asked.variety));
  section.settings.emplace_back("seed", absl::StrCat(arguments.asked.seed));
  return section;
}

absl::Status Run(const Arguments& arguments) {
  absl::StatusOr<Experiment> experiment = OpenExperiment(arguments.flags);
  if (!experiment.ok()) return experiment.status();
  const dataset::Dataset& dataset = experiment->dataset;
  report::ResultSection section = MakeSection(*experiment, arguments);
  absl::StatusOr<std::vector<report::Table>> tables =
      Tables(dataset, experiment->models, experiment->subjects, arguments);
  if (!tables.ok()) return tables.status();
  section.tables = *std::move(tables);
  return FinishSection(arguments.flags.section, section);
}

}  // namespace

void AddLongCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app->add_subcommand("long", "Whether followers of long clips stand, near their leaders");
  AddExperimentFlags("16_long", "Clips of a minute and of ten", &arguments->flags, command);
  AddModelFlags(ModelNeeded::kYes, &arguments->flags.models, command);
  AddStartsFlag(&arguments->starts, command);
  AddSamplingFlags(&arguments->asked, command);
  command->add_option("--seconds", arguments->seconds, "how long leaders last")
      ->delimiter(',')
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  RunWhenNamed(command, arguments, Run, chosen);
}

}  // namespace duet::evaluation::program
