#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/evaluation/experiments/long_clips.h"
#include "model/evaluation/experiments/long_leaders.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/model_flags.h"
#include "model/evaluation/report/long_tables.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::program {
namespace {

struct Arguments {
  ExperimentFlags flags;
  std::vector<double> seconds = {60, 600};
};

// The answers of one fold's model to every leader in every class.
absl::Status AddFold(const dataset::Dataset& dataset, const FoldModel& model, const Fold& fold,
                     double seconds, experiments::StartGiven start,
                     const experiments::AskedSamples& sampling,
                     std::vector<experiments::LongClipRow>* rows) {
  absl::StatusOr<SharedSynthesizer> synthesizer = model.load(fold.subject);
  if (!synthesizer.ok()) return synthesizer.status();
  absl::Status fits = CheckModelTakes((*synthesizer)->description(), dataset, start);
  if (!fits.ok()) return fits;
  std::vector<experiments::LongLeader> leaders;
  for (int c = 0; c < dataset.class_count(); ++c) {
    for (auto& leader : experiments::MakeLongLeaders(dataset, fold.split.test, c, seconds)) {
      leaders.push_back(std::move(leader));
    }
  }
  std::vector<experiments::LabelledLeader> asked;
  for (const experiments::LongLeader& leader : leaders) {
    std::vector<float> labels(dataset.classes.size());
    labels[static_cast<size_t>(leader.sequence.interaction_class)] = 1;
    asked.push_back(
        {&leader.sequence, std::move(labels), {sampling.seed + asked.size(), sampling.variety}});
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
  std::cerr << absl::StrCat(model.name, StartSuffix(start), " without ", fold.subject, ": ",
                            leaders.size(), " leaders of ", seconds, " s\n");
  return absl::OkStatus();
}

// The same figures for captured followers of the left-out people, clip by clip.
std::vector<experiments::LongClipRow> CapturedRows(const Experiment& experiment) {
  const dataset::Dataset& dataset = experiment.dataset;
  std::vector<experiments::LongClipRow> rows;
  for (const Fold& fold : experiment.folds) {
    for (const int s : fold.split.test) {
      const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(s)];
      rows.push_back(
          {"people", "clips as captured", sequence.interaction_class,
           experiments::MeasureLongClip(dataset.skeleton, sequence.pair.leader.poses,
                                        sequence.pair.follower.poses, dataset.frame_rate_hz)});
    }
  }
  return rows;
}

absl::StatusOr<std::vector<report::Table>> Tables(const Experiment& experiment,
                                                  const Arguments& arguments) {
  const dataset::Dataset& dataset = experiment.dataset;
  const std::vector<experiments::LongClipRow> captured = CapturedRows(experiment);
  std::vector<report::Table> tables;
  for (const double seconds : arguments.seconds) {
    for (const std::string& start : arguments.flags.starts) {
      std::vector<experiments::LongClipRow> rows = captured;
      for (const FoldModel& model : experiment.models) {
        for (const Fold& fold : experiment.folds) {
          absl::Status status = AddFold(dataset, model, fold, seconds, ParseStart(start),
                                        arguments.flags.asked, &rows);
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
  section.settings.emplace_back("variety", absl::StrCat(arguments.flags.asked.variety));
  section.settings.emplace_back("seed", absl::StrCat(arguments.flags.asked.seed));
  return section;
}

absl::Status Run(const Arguments& arguments) {
  absl::StatusOr<Experiment> experiment = OpenExperiment(arguments.flags);
  if (!experiment.ok()) return experiment.status();
  report::ResultSection section = MakeSection(*experiment, arguments);
  absl::StatusOr<std::vector<report::Table>> tables = Tables(*experiment, arguments);
  if (!tables.ok()) return tables.status();
  section.tables = *std::move(tables);
  return FinishSection(arguments.flags.section, section);
}

}  // namespace

void AddLongCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app->add_subcommand("long", "Posture and place of followers in long clips");
  AddAnswersFlags("16_long", "Clips of a minute and of ten", &arguments->flags, command);
  command->add_option("--seconds", arguments->seconds, "lengths of the leaders, seconds")
      ->delimiter(',')
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  RunWhenNamed(command, arguments, Run, chosen);
}

}  // namespace duet::evaluation::program
