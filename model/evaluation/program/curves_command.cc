#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/file.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/named_runs.h"
#include "model/evaluation/report/result_section.h"
#include "model/evaluation/report/training_curves.h"

namespace duet::evaluation::program {
namespace {

struct Arguments {
  std::vector<std::string> runs;
  std::string out;
  std::string id = "60_curves";
  std::string title = "Training curves";
};

absl::StatusOr<report::LoggedRun> ReadRun(const std::string& argument) {
  absl::StatusOr<NamedRuns> run = ParseRuns(argument);
  if (!run.ok()) return run.status();
  const std::filesystem::path file = run->folder / "log.csv";
  const absl::StatusOr<std::string> text =
      base::ReadFile(file, experiments::kMaxTrainingLogBytes, "a training log");
  if (!text.ok()) return text.status();
  absl::StatusOr<experiments::TrainingLog> log =
      experiments::ParseTrainingLog(*text, file.string());
  if (!log.ok()) return log.status();
  return report::LoggedRun{run->name, *std::move(log)};
}

absl::Status Run(const Arguments& arguments) {
  std::vector<report::LoggedRun> runs;
  std::string command = "duet-eval curves --run";
  for (const std::string& argument : arguments.runs) {
    absl::StatusOr<report::LoggedRun> run = ReadRun(argument);
    if (!run.ok()) return run.status();
    absl::StrAppend(&command, " ", run->name, "=RUN");
    runs.push_back(*std::move(run));
  }
  report::ResultSection section = DrawTrainingCurves(runs, arguments.id);
  section.title = arguments.title;
  section.text = {
      "What duet-train logged. Losses are means over an epoch's batches, before their weights, but "
      "for the generator's weighted sum; a loss that was switched off is not shown."};
  section.settings = {{"runs", absl::StrCat(runs.size())}};
  section.command = command;
  section.date = report::Today();
  for (const report::Table& table : section.tables) std::cout << ToPlainText(table) << "\n";
  return arguments.out.empty() ? absl::OkStatus() : WriteSection(section, arguments.out);
}

}  // namespace

void AddCurvesCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app->add_subcommand("curves", "Training curves of runs of duet-train");
  command
      ->add_option("--run,--runs", arguments->runs,
                   "[NAME=]DIR, the folder of a run, which holds log.csv; several may follow")
      ->required();
  command->add_option("--out", arguments->out, "folder of results, for duet-eval report");
  command->add_option("--id", arguments->id, "of the section")->capture_default_str();
  command->add_option("--title", arguments->title, "of the section")->capture_default_str();
  command->callback([arguments, chosen] { *chosen = [arguments] { return Run(*arguments); }; });
}

}  // namespace duet::evaluation::program
