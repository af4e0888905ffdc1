#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/flags.h"
#include "model/evaluation/report/data_tables.h"
#include "model/training/direction_fit.h"

// The commands that measure captures: their properties, and what a model makes of their directions.

namespace duet::evaluation::program {
namespace {

struct DataArguments {
  std::string data;
  SectionFlags section = {"05_data", "The captures: tilt, noise, leaders"};
};

absl::Status RunData(const DataArguments& arguments) {
  DUET_TRY(const dataset::Dataset dataset, dataset::ReadDataset(arguments.data));
  report::ResultSection section = BeginSection(
      arguments.section,
      "Properties of the data set for training and evaluation. Each set of captures is levelled "
      "when it is read; figures in SBU's raw unit are measured before levelling.");
  section.tables = {report::LeanTable(dataset), report::FloorTable(dataset),
                    report::NoiseTable(dataset), report::LeaderTable(dataset),
                    report::SolverTable(dataset)};
  section.settings = {{"data", DescribeData(dataset)}};
  return FinishSection(arguments.section, section);
}

// Reads the regression of a fold's model, if it has one. Errors: those of reading it;
// INVALID_ARGUMENT for other joints.
absl::StatusOr<std::optional<engine::DirectionRegression>> ReadFold(
    const dataset::Dataset& dataset, const std::filesystem::path& run) {
  DUET_TRY(checkpoint::Checkpoint checkpoint, ReadRunCheckpoint(run));
  const engine::ModelDescription& model = checkpoint.manifest.model;
  if (model.skeleton.joint_names == dataset.skeleton.joint_names) return model.partner_direction;
  return absl::InvalidArgumentError(absl::StrCat(run.string(), ": expected the data set's ",
                                                 dataset.skeleton.joint_count(), " joints, got ",
                                                 model.skeleton.joint_count()));
}

// The hips' row, then one for each of the runs: the number of tests, and median and 90th percentile
// of their errors.
absl::StatusOr<report::Table> MeasureDirection(const ExperimentFlags& flags,
                                               const dataset::Dataset& dataset) {
  report::Table table{"Where the partner is expected: degrees off",
                      {"tests", "median", "90th percentile"}};
  table.decimals = 1;
  table.notes = {
      "Hips: where the leader's hips face in the first frame. A model: its own estimate from the "
      "leader's motion, or the hips if it has none."};
  DUET_TRY(const std::vector<Fold> folds, LeaveOut(dataset, flags.subjects));
  std::vector<NamedRuns> rows = {{"hips", {}}};
  for (const std::string& text : flags.models.runs) {
    DUET_TRY(rows.emplace_back(), ParseRuns(text));
  }
  for (const NamedRuns& runs : rows) {
    std::vector<double> errors;
    for (const Fold& fold : folds) {
      std::optional<engine::DirectionRegression> regression;
      if (!runs.folder.empty()) {
        DUET_TRY(regression, ReadFold(dataset, runs.folder / fold.subject));
      }
      const std::vector<double> of_fold =
          training::DirectionErrors(dataset, fold.split.test, regression);
      errors.insert(errors.end(), of_fold.begin(), of_fold.end());
    }
    table.rows.push_back({runs.name,
                          {static_cast<double>(errors.size()), base::Quantile(errors, 0.5),
                           base::Quantile(errors, 0.9)}});
  }
  return table;
}

absl::Status RunDirection(const ExperimentFlags& flags) {
  DUET_TRY(const dataset::Dataset dataset, dataset::ReadDataset(flags.data));
  if (!dataset.skeleton.hips) {
    return absl::InvalidArgumentError(
        absl::StrCat("--data: expected a skeleton with hips, got that of ", dataset.name));
  }
  report::ResultSection section = BeginSection(
      flags.section,
      "If a request has neither a partner direction nor a follower start, the direction is "
      "estimated from the leader's motion. Each subject is left out of training in turn; lower is "
      "better.");
  DUET_TRY(section.tables.emplace_back(), MeasureDirection(flags, dataset));
  section.settings = {{"data", DescribeData(dataset)}};
  return FinishSection(flags.section, section);
}

}  // namespace

void AddDataCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] = AddCommand(
      "data",
      "Tilt, noise and leaders of a data set, before and after reading, and the effect of clean-up",
      RunData, app, chosen);
  AddDataFlag(&arguments->data, command);
  AddSectionFlags(&arguments->section, command);
}

void AddDirectionCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [flags, command] = AddCommand(
      "direction", "Errors of the partner's direction when a model estimates it from the leader",
      RunDirection, app, chosen);
  AddExperimentFlags("06_direction", "Where the partner of a leader is expected", flags, command);
  command
      ->add_option("--runs", flags->models.runs, "output of duet-train --protocol loso; repeatable")
      ->type_name(kNamedRuns);
}

}  // namespace duet::evaluation::program
