#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/file.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/named_runs.h"
#include "model/evaluation/report/result_section.h"
#include "model/evaluation/report/validation_table.h"

namespace duet::evaluation::program {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<std::string> runs;
  std::string out;
  std::string id = "22_validation";
  std::string title = "Settings compared on validation subjects";
};

absl::StatusOr<std::vector<fs::path>> RunFolders(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (fs::exists(entry.path() / "log.csv")) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  if (!found.empty()) return found;
  return absl::NotFoundError(
      absl::StrCat(folder.string(), ": no <run>/log.csv, wanted output of duet-train"));
}

absl::StatusOr<report::ValidatedRuns> ReadRuns(const std::string& argument) {
  absl::StatusOr<NamedRuns> named = ParseRuns(argument);
  if (!named.ok()) return named.status();
  absl::StatusOr<std::vector<fs::path>> folders = RunFolders(named->folder);
  if (!folders.ok()) return folders.status();
  report::ValidatedRuns runs = {named->name, {}};
  for (const fs::path& folder : *folders) {
    const fs::path file = folder / "log.csv";
    absl::StatusOr<std::string> text =
        base::ReadFile(file, experiments::kMaxTrainingLogBytes, "a training log");
    if (!text.ok()) return text.status();
    absl::StatusOr<experiments::TrainingLog> log =
        experiments::ParseTrainingLog(*text, file.string());
    if (!log.ok()) return log.status();
    runs.runs.push_back({folder.filename().string(), *std::move(log)});
  }
  return runs;
}

absl::Status Run(const Arguments& arguments) {
  std::vector<report::ValidatedRuns> all;
  std::string command = "duet-eval validation --runs";
  for (const std::string& argument : arguments.runs) {
    absl::StatusOr<report::ValidatedRuns> runs = ReadRuns(argument);
    if (!runs.ok()) return runs.status();
    absl::StrAppend(&command, " ", runs->name, "=RUNS");
    all.push_back(*std::move(runs));
  }
  report::ResultSection section;
  section.id = arguments.id;
  section.title = arguments.title;
  section.text = {
      "Average frame distance in metres after the last epoch, on validation subjects. A column is "
      "the subject that a run left out altogether; another one validated it. Lower is better; what "
      "differs less than two seeds do means nothing."};
  section.tables = {
      ValidationTable("Without a start: afd, metres", "validation_afd", all),
      ValidationTable("Told the first pose: afd, metres", "validation_afd_pose", all)};
  section.command = command;
  section.date = report::Today();
  for (const report::Table& table : section.tables) std::cout << ToPlainText(table) << "\n";
  return arguments.out.empty() ? absl::OkStatus() : WriteSection(section, arguments.out);
}

}  // namespace

void AddValidationCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app->add_subcommand("validation", "Settings compared on what their runs held back");
  command
      ->add_option("--runs", arguments->runs,
                   "[NAME=]DIR, output of duet-train with validation subjects; several may follow")
      ->required();
  command->add_option("--out", arguments->out, "folder of results, for duet-eval report");
  command->add_option("--id", arguments->id, "of the section")->capture_default_str();
  command->add_option("--title", arguments->title, "of the section")->capture_default_str();
  command->callback([arguments, chosen] { *chosen = [arguments] { return Run(*arguments); }; });
}

}  // namespace duet::evaluation::program
