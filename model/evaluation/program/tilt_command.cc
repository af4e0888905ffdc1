#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/evaluation/experiments/tilted_answers.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/model_flags.h"

namespace duet::evaluation::program {
namespace {

using experiments::TiltedFigures;

struct Arguments {
  Arguments() {
    flags.starts = {"none"};
    flags.asked.samples = 4;
  }

  ExperimentFlags flags;
  std::vector<double> degrees = {10};
  bool as_captured = false;
  bool estimated_direction = false;
};

// The tilts of a table: with an angle, towards each of four sides.
std::vector<experiments::Camera> CamerasOf(double degrees) {
  std::vector<experiments::Camera> cameras;
  for (const double azimuth : {0, 90, 180, 270}) cameras.push_back({degrees, azimuth});
  return cameras;
}

// One model for everything answers all sequences; otherwise, each fold's model answers its own.
absl::StatusOr<std::vector<Fold>> FoldsOf(const Arguments& arguments,
                                          const dataset::Dataset& dataset) {
  if (!arguments.flags.models.one_for_all()) return LeaveOut(dataset, arguments.flags.subjects);
  Fold all;
  for (size_t i = 0; i < dataset.sequences.size(); ++i) {
    all.split.test.push_back(static_cast<int>(i));
  }
  return std::vector<Fold>{std::move(all)};
}

// Adds figures of so many sequences to those before.
void Add(const std::vector<TiltedFigures>& more, double weight, std::vector<TiltedFigures>* sum) {
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
  report::Table table;
  table.title = title;
  table.columns = {"error cm", "worse %", "levelled %", "tilt left"};
  table.decimals = 1;
  for (const TiltedFigures& row : rows) {
    table.rows.push_back(
        {row.name,
         {100 * row.error_metres, 100 * (row.error_metres / rows[0].error_metres - 1),
          100 * row.levelled_share, row.residual_degrees}});
  }
  return table;
}

absl::StatusOr<report::Table> Measure(const Arguments& arguments, const Experiment& experiment,
                                      const FoldModel& model, const std::string& start,
                                      const std::string& title,
                                      const std::vector<experiments::Camera>& cameras) {
  double sequences = 0;
  for (const Fold& fold : experiment.folds) {
    sequences += static_cast<double>(fold.split.test.size());
  }
  std::vector<TiltedFigures> sum;
  for (const Fold& fold : experiment.folds) {
    const absl::StatusOr<SharedSynthesizer> synthesizer = model.load(fold.subject);
    if (!synthesizer.ok()) return synthesizer.status();
    for (const experiments::Camera& camera : cameras) {
      const absl::StatusOr<std::vector<TiltedFigures>> figures =
          AnswerTilted(**synthesizer, experiment.dataset, fold.split.test, ParseStart(start),
                       arguments.flags.asked, camera);
      if (!figures.ok()) return figures.status();
      const double weight = static_cast<double>(fold.split.test.size()) /
                            (sequences * static_cast<double>(cameras.size()));
      Add(*figures, weight, &sum);
    }
  }
  return ToTable(absl::StrCat(model.name, StartSuffix(ParseStart(start)), ", ", title), sum);
}

absl::Status Run(const Arguments& given) {
  Arguments arguments = given;
  arguments.flags.asked.tell_direction = !arguments.estimated_direction;
  absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(arguments.flags.data);
  if (!dataset.ok()) return dataset.status();
  absl::StatusOr<std::vector<Fold>> folds = FoldsOf(arguments, *dataset);
  if (!folds.ok()) return folds.status();
  absl::StatusOr<std::vector<FoldModel>> models = OpenModels(arguments.flags.models);
  if (!models.ok()) return models.status();
  const Experiment experiment{*std::move(dataset), *std::move(folds), *std::move(models)};
  report::ResultSection section = BeginAnswers(
      arguments.flags, experiment,
      "Answers to leaders of a tilted camera, in the level world: the mean distance of the joints "
      "from the captured follower as one vector (afd), and by how much that exceeds leaders that "
      "were never tilted. Auto levels only where the evidence is strong: that of one file with two "
      "people, or of all files of a set.");
  section.settings.emplace_back("samples", absl::StrCat(arguments.flags.asked.samples));
  section.settings.emplace_back("partner direction",
                                arguments.estimated_direction ? "estimated" : "stated");
  for (const FoldModel& model : experiment.models) {
    for (const std::string& start : arguments.flags.starts) {
      const auto add = [&](const std::string& title,
                           const std::vector<experiments::Camera>& cameras) {
        absl::StatusOr<report::Table> table =
            Measure(arguments, experiment, model, start, title, cameras);
        if (table.ok()) section.tables.push_back(*std::move(table));
        return table.status();
      };
      absl::Status status;
      if (arguments.as_captured) status = add("tilted as captured", {{0, std::nullopt}});
      for (const double degrees : arguments.degrees) {
        if (!status.ok()) return status;
        status = add(absl::StrFormat("tilted by %g degrees to each of four sides", degrees),
                     CamerasOf(degrees));
      }
      if (!status.ok()) return status;
    }
  }
  return FinishSection(arguments.flags.section, section);
}

}  // namespace

void AddTiltCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app->add_subcommand("tilt", "What a camera's tilt costs, and what levelling saves");
  AddAnswersFlags("07_tilt", "Leaders of a tilted camera", &arguments->flags, command);
  command->add_option("--degrees", arguments->degrees, "tilts of the camera, to each of four sides")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 44.0))
      ->capture_default_str();
  command->add_flag("--as-captured", arguments->as_captured,
                    "add a table of the tilt that the data set was captured with");
  command->add_flag("--estimate-direction", arguments->estimated_direction,
                    "leave the partner's direction to the model's estimate");
  RunWhenNamed(command, arguments, Run, chosen);
}

}  // namespace duet::evaluation::program
