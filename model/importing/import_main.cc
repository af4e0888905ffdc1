// duet-import: converts a folder of motion files of two people to a data set for training.
//
//   duet-import --from captures --out studio
//   duet-import --solve studio --out studio-solved

#include <CLI/CLI.hpp>
#include <iostream>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "model/base/counted.h"
#include "model/base/program_flags.h"
#include "model/base/program_output.h"
#include "model/importing/import.h"
#include "model/motion/coordinates.h"

namespace duet::importing {
namespace {

// Flags that Parse reads, because CLI11 does not know their types.
struct Words {
  std::string solve;  // a data set
  std::string up_axis;
  std::string level;
  std::vector<std::string> joints;  // JOINT=FILE_JOINT
};

void Declare(ImportOptions* options, Words* words, CLI::App* app) {
  CLI::Option* const from =
      app->add_option("--from", options->from, "Folder of motion files")->type_name("DIR");
  app->add_option(
         "--solve", words->solve,
         "Data set whose people to turn into bodies: constant bones, feet that stand; with "
         "--out and --overwrite only")
      ->type_name("DIR")
      ->excludes(from);
  app->add_option("--out", options->out, "Data set to write")->required()->type_name("DIR");
  app->add_option("--name", options->name, "Name of the data set (default: the name of its folder)")
      ->type_name("NAME");
  app->add_option("--table", options->table,
                  "Tab-separated table of leader, follower, label and subjects (default: "
                  "FROM/pairs.tsv, if it exists)")
      ->type_name("FILE");
  app->add_option("--skeleton", options->skeleton,
                  "sbu, or a file with the skeleton object of dataset.json (default: inferred)")
      ->type_name("FILE");
  app->add_option(
         "--joint-map", words->joints,
         "Joint of the file for a joint of the skeleton, if its name is ambiguous; repeatable")
      ->type_name("JOINT=FILE_JOINT");
  app->add_option("--frame-rate", options->frame_rate_hz,
                  "Frame rate of the files (default: the rate that they state)")
      ->check(base::InRange(1.0, 1000.0))
      ->type_name("HZ");
  app->add_option("--to-rate", options->to_rate_hz,
                  "Frame rate of the data set (default: that of the files, at most "
                  "30)")
      ->check(base::InRange(1.0, 240.0))
      ->type_name("HZ");
  app->add_option("--metres-per-unit", options->metres_per_unit,
                  "Metres in one unit of the files, 0.01 for centimetres (default: inferred)")
      ->check(base::InRange(1e-6, 1e6))
      ->type_name("METRES");
  app->add_option("--up-axis", words->up_axis,
                  "Up axis of the files (default: the axis along which people "
                  "stand)")
      ->type_name("y-up|z-up|y-down");
  app->add_option("--longest", options->longest_seconds,
                  "Maximum length of a sequence; longer ones are cut")
      ->check(base::InRange(0.1, 86400.0))
      ->capture_default_str()
      ->type_name("SECONDS");
  app->add_option("--symmetric", options->symmetric, "Classes in which either person may lead")
      ->delimiter(',')
      ->type_name("CLASS");
  app->add_option("--handed", options->handed,
                  "Classes that are always done with the same hand; they are not mirrored")
      ->delimiter(',')
      ->type_name("CLASS");
  app->add_option("--touches", options->touches, "Classes in which bodies may touch")
      ->delimiter(',')
      ->type_name("CLASS");
  app->add_option("--level", words->level, "Level the people (default: if they lean or float)")
      ->check(CLI::IsMember({"yes", "no"}))
      ->type_name("yes|no");
  app->add_flag("--skip-refused", options->skip_refused, "Continue without rejected pairs");
  app->add_flag("--overwrite", options->overwrite, "Replace the data set at --out");
}

absl::Status Wrong(const std::string& flag, const std::string& got, const std::string& expected) {
  return absl::InvalidArgumentError(absl::StrCat(flag, ": expected ", expected, ", got ", got));
}

absl::Status Parse(const Words& words, ImportOptions* options) {
  if (!words.level.empty()) options->level = words.level == "yes";
  if (!words.up_axis.empty()) {
    options->up_axis = motion::ParseUpAxis(words.up_axis);
    if (!options->up_axis) return Wrong("--up-axis", words.up_axis, motion::kUpAxisNames);
  }
  for (const std::string& word : words.joints) {
    std::pair<std::string, std::string> parts = absl::StrSplit(word, absl::MaxSplits('=', 1));
    if (parts.second.empty()) return Wrong("--joint-map", word, "JOINT=FILE_JOINT");
    options->joint_overrides.insert(std::move(parts));
  }
  return absl::OkStatus();
}

void Print(const ImportReport& report) {
  for (const Assumption& one : report.assumptions) {
    std::cout << one.what << ": " << one.value;
    if (!one.flag.empty()) std::cout << "  [" << one.flag << "]";
    std::cout << "\n";
  }
  for (const Refusal& one : report.refused) {
    std::cerr << "refused: " << one.name << ": " << one.reason << "\n";
  }
}

void Print(const SolveReport& report) {
  std::cout << absl::StrFormat("moved %.1f cm on average; farthest:\n", report.moved * 100);
  for (const SolvedSequence& one : report.most_moved) {
    std::cout << absl::StrFormat("moved %.1f cm: %s\n", one.metres * 100, one.id);
  }
}

int Fail(const absl::Status& status) {
  std::cerr << "duet-import: " << status.message() << "\n";
  return 1;
}

// The first given flag that has no meaning with --solve.
std::optional<std::string> FlagBesideSolve(const CLI::App& app) {
  const std::set<std::string> meant = {"--solve", "--out", "--overwrite"};
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = "--" + option->get_single_name();
    if (option->count() > 0 && meant.count(name) == 0) return name;
  }
  return std::nullopt;
}

int RunSolve(const std::string& from, const ImportOptions& options) {
  SolveReport report;
  const absl::Status status = Solve(from, options.out, options.overwrite, &report);
  if (!status.ok()) return Fail(status);
  Print(report);
  std::cout << options.out.string() << ": " << base::Counted(report.sequences, "sequence")
            << " solved\n";
  return 0;
}

int Run(int argc, char** argv) {
  ImportOptions options;
  Words words;
  CLI::App app("Converts a folder of motion files of two people to a data set for training.",
               "duet-import");
  app.set_version_flag("--version", "duet-import " DUET_VERSION);
  Declare(&options, &words, &app);
  if (const std::optional<int> code = base::ParseFlags(argc, argv, &app)) return *code;
  if (!words.solve.empty()) {
    const std::optional<std::string> beside = FlagBesideSolve(app);
    if (beside) return Fail(Wrong(*beside, "it", "only --out and --overwrite with --solve"));
    return RunSolve(words.solve, options);
  }
  ImportReport report;
  absl::Status status = Parse(words, &options);
  if (status.ok() && options.from.empty()) {
    status = absl::InvalidArgumentError("--from: expected a folder of motion files, got none");
  }
  if (status.ok()) status = Import(options, &report);
  Print(report);
  if (!status.ok()) return Fail(status);
  std::cout << options.out.string() << ": " << base::Counted(report.sequences, "sequence") << " of "
            << base::Counted(report.pairs, "pair") << "; " << report.refused.size() << " refused\n";
  return 0;
}

}  // namespace
}  // namespace duet::importing

int main(int argc, char** argv) {
  return duet::base::FinishOutput("duet-import", duet::importing::Run(argc, argv));
}
