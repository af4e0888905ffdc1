#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/experiments/tilted_answers.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/flags.h"
#include "model/evaluation/report/data_tables.h"
#include "model/training/direction_fit.h"

// The commands that measure captures: their properties, and what a model makes of their directions
// and tilts.

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

using experiments::TiltedFigures;

struct TiltArguments : ExperimentFlags {
  std::vector<double> degrees = {10};
  bool as_captured = false;
};

// Adds figures of so many sequences to those before.
void AddFigures(const std::vector<TiltedFigures>& more, double weight,
                std::vector<TiltedFigures>* sum) {
  if (sum->empty()) {
    for (const TiltedFigures& one : more) sum->push_back({one.name});
  }
  for (size_t i = 0; i < more.size(); ++i) {
    (*sum)[i].error_metres += weight * more[i].error_metres;
    (*sum)[i].levelled_share += weight * more[i].levelled_share;
    (*sum)[i].residual_degrees += weight * more[i].residual_degrees;
  }
}

report::Table ToTable(const std::string& title, const std::vector<TiltedFigures>& rows) {
  report::Table table{title, {"error cm", "worse %", "levelled %", "tilt left"}, {}, {}, 1};
  for (const TiltedFigures& row : rows) {
    table.rows.push_back(
        {row.name,
         {100 * row.error_metres, 100 * (row.error_metres / rows[0].error_metres - 1),
          100 * row.levelled_share, row.residual_degrees}});
  }
  return table;
}

absl::StatusOr<report::Table> MeasureTilt(const TiltArguments& arguments,
                                          const Experiment& experiment, const FoldModel& model,
                                          const std::string& start, const std::string& title,
                                          const std::vector<experiments::Camera>& cameras) {
  double sequences = 0;
  for (const Fold& fold : experiment.folds) {
    sequences += static_cast<double>(fold.split.test.size());
  }
  std::vector<TiltedFigures> sum;
  for (const Fold& fold : experiment.folds) {
    DUET_TRY(const SharedSynthesizer synthesizer, model.load(fold.subject));
    for (const experiments::Camera& camera : cameras) {
      DUET_TRY(const std::vector<TiltedFigures> figures,
               AnswerTilted(*synthesizer, experiment.dataset, fold.split.test, ParseStart(start),
                            arguments.asked, camera));
      const double weight = static_cast<double>(fold.split.test.size()) /
                            (sequences * static_cast<double>(cameras.size()));
      AddFigures(figures, weight, &sum);
    }
  }
  return ToTable(absl::StrCat(model.name, StartSuffix(ParseStart(start)), ", ", title), sum);
}

absl::Status RunTilt(const TiltArguments& arguments) {
  DUET_TRY(dataset::Dataset dataset, dataset::ReadDataset(arguments.data));
  // One model for everything answers all sequences; otherwise, each fold's model answers its own.
  std::vector<Fold> folds = {{"", {{}, dataset::AllSequences(dataset)}}};
  if (!arguments.models.one_for_all()) {
    DUET_TRY(folds, LeaveOut(dataset, arguments.subjects));
  }
  DUET_TRY(std::vector<FoldModel> models, OpenModels(arguments.models));
  const Experiment experiment{std::move(dataset), std::move(folds), std::move(models)};
  report::ResultSection section = BeginAnswers(
      arguments, experiment,
      "Answers to leaders of a tilted camera, in the level world: the mean distance of the joints "
      "from the captured follower as one vector (afd), and by how much that exceeds leaders that "
      "were never tilted. Auto levels only where the evidence is strong: that of one file with two "
      "people, or of all files of a set.");
  section.settings.emplace_back("samples", absl::StrCat(arguments.asked.samples));
  section.settings.emplace_back("partner direction",
                                arguments.asked.tell_direction ? "stated" : "estimated");
  for (const FoldModel& model : experiment.models) {
    for (const std::string& start : arguments.starts) {
      const auto measure = [&](const std::string& title,
                               const std::vector<experiments::Camera>& cameras) {
        return MeasureTilt(arguments, experiment, model, start, title, cameras);
      };
      if (arguments.as_captured) {
        DUET_TRY(section.tables.emplace_back(), measure("tilted as captured", {{0, std::nullopt}}));
      }
      for (const double degrees : arguments.degrees) {
        std::vector<experiments::Camera> cameras;
        for (const double azimuth : {0, 90, 180, 270}) cameras.push_back({degrees, azimuth});
        DUET_TRY(section.tables.emplace_back(),
                 measure(absl::StrFormat("tilted by %g degrees to each of four sides", degrees),
                         cameras));
      }
    }
  }
  return FinishSection(arguments.section, section);
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

void AddTiltCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] = AddCommand(
      "tilt", "What a camera's tilt costs, and what levelling saves", RunTilt, app, chosen);
  arguments->starts = {"none"};
  arguments->asked.samples = 4;
  AddAnswersFlags("07_tilt", "Leaders of a tilted camera", arguments, command);
  AddNumber("--degrees", &arguments->degrees, 0.0, 44.0,
            "tilts of the camera, to each of four sides", command)
      ->delimiter(',');
  command->add_flag("--as-captured", arguments->as_captured,
                    "add a table of the tilt that the data set was captured with");
  command->add_flag("!--estimate-direction", arguments->asked.tell_direction,
                    "leave the partner's direction to the model's estimate");
}

}  // namespace duet::evaluation::program
