#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/experiments/direction_errors.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/models.h"
#include "model/evaluation/program/section_flags.h"
#include "model/evaluation/report/direction_table.h"

namespace duet::evaluation::program {
namespace {

// Reads the regression of a fold's model, if it has one. Errors: those of reading it;
// INVALID_ARGUMENT for other joints.
absl::StatusOr<std::optional<engine::DirectionRegression>> ReadFold(
    const dataset::Dataset& dataset, const std::filesystem::path& run) {
  absl::StatusOr<checkpoint::Checkpoint> checkpoint = ReadRunCheckpoint(run);
  if (!checkpoint.ok()) return checkpoint.status();
  const engine::ModelDescription& model = checkpoint->manifest.model;
  if (model.skeleton.joint_names == dataset.skeleton.joint_names) return model.partner_direction;
  return absl::InvalidArgumentError(absl::StrCat(run.string(), ": expected the data set's ",
                                                 dataset.skeleton.joint_count(), " joints, got ",
                                                 model.skeleton.joint_count()));
}

// The hips' row, then one for each of the runs.
absl::StatusOr<std::vector<report::DirectionRow>> Measure(const ExperimentFlags& flags,
                                                          const dataset::Dataset& dataset) {
  const absl::StatusOr<std::vector<Fold>> folds = LeaveOut(dataset, flags.subjects);
  if (!folds.ok()) return folds.status();
  std::vector<NamedRuns> runs;
  std::vector<report::DirectionRow> rows = {{"hips", {}}};
  for (const std::string& text : flags.models.runs) {
    absl::StatusOr<NamedRuns> named = ParseRuns(text);
    if (!named.ok()) return named.status();
    rows.push_back({named->name, {}});
    runs.push_back(*std::move(named));
  }
  for (const Fold& fold : *folds) {
    const auto add = [&](const std::optional<engine::DirectionRegression>& regression,
                         report::DirectionRow* row) {
      const std::vector<double> errors =
          experiments::DirectionErrors(dataset, fold.split.test, regression);
      row->errors.insert(row->errors.end(), errors.begin(), errors.end());
    };
    add(std::nullopt, &rows[0]);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const auto regression = ReadFold(dataset, runs[i].folder / fold.subject);
      if (!regression.ok()) return regression.status();
      add(*regression, &rows[i + 1]);
    }
  }
  return rows;
}

absl::Status Run(const ExperimentFlags& flags) {
  const absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(flags.data);
  if (!dataset.ok()) return dataset.status();
  if (!dataset->skeleton.hips) {
    return absl::InvalidArgumentError(
        absl::StrCat("--data: expected a skeleton with hips, got that of ", dataset->name));
  }
  const absl::StatusOr<std::vector<report::DirectionRow>> rows = Measure(flags, *dataset);
  if (!rows.ok()) return rows.status();
  report::ResultSection section = BeginSection(
      flags.section,
      "If a request has neither a partner direction nor a follower start, the direction is "
      "estimated from the leader's motion. Each subject is left out of training in turn; lower is "
      "better.");
  section.tables = {report::DirectionTable(*rows)};
  section.settings = {{"data", DescribeData(*dataset)}};
  return FinishSection(flags.section, section);
}

}  // namespace

void AddDirectionCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto flags = std::make_shared<ExperimentFlags>();
  CLI::App* command = app->add_subcommand(
      "direction", "Errors of the partner's direction when a model estimates it from the leader");
  AddExperimentFlags("06_direction", "Where the partner of a leader is expected", flags.get(),
                     command);
  command
      ->add_option("--runs", flags->models.runs, "output of duet-train --protocol loso; repeatable")
      ->type_name(kNamedRuns);
  RunWhenNamed(command, flags, Run, chosen);
}

}  // namespace duet::evaluation::program
