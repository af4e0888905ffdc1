// duet-import: converts a folder of motion files of two people to a data set for training.
//
//   duet-import --from captures --out studio
//   duet-import --solve studio --out studio-solved

#include <CLI/CLI.hpp>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "model/base/counted.h"
#include "model/base/program_flags.h"
#include "model/base/program_output.h"
#include "model/base/text.h"
#include "model/importing/import.h"
#include "model/motion/coordinates.h"

namespace duet::importing {
namespace {

void Declare(ImportOptions* options, std::string* solved, CLI::App* app) {
  app->add_option("--from", options->from, "Folder of motion files")->type_name("DIR");
  app->add_option(
         "--solve", *solved,
         "Data set whose people to turn into bodies: constant bones, feet that stand; with "
         "--out and --overwrite only")
      ->type_name("DIR");
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
  app->add_option_function<std::vector<std::string>>(
         "--joint-map",
         [options](const std::vector<std::string>& words) {
           for (const std::string& word : words) {
             const std::pair<std::string, std::string> joints =
                 absl::StrSplit(word, absl::MaxSplits('=', 1));
             options->joint_overrides.insert(joints);
           }
         },
         "Joint of the file for a joint of the skeleton, if its name is ambiguous; repeatable")
      ->check([](const std::string& word) {
        const size_t equals = word.find('=');
        const bool pair = equals != std::string::npos && equals + 1 < word.size();
        return pair ? "" : absl::StrCat("expected JOINT=FILE_JOINT, got ", base::Quoted(word));
      })
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
  app->add_option_function<std::string>(
         "--up-axis",
         [options](const std::string& word) { options->up_axis = motion::ParseUpAxis(word); },
         "Up axis of the files (default: the axis along which people stand)")
      ->check(CLI::IsMember({"y-up", "z-up", "y-down"}))
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
  app->add_option("--level", options->level, "Level the people (default: if they lean or float)")
      ->check(CLI::IsMember({"yes", "no"}))
      ->type_name("yes|no");
  app->add_flag("--skip-refused", options->skip_refused, "Continue without rejected pairs");
  app->add_flag("--overwrite", options->overwrite, "Replace the data set at --out");
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
  std::string solved;
  CLI::App app("Converts a folder of motion files of two people to a data set for training.",
               "duet-import");
  app.set_version_flag("--version", "duet-import " DUET_VERSION);
  Declare(&options, &solved, &app);
  if (const std::optional<int> code = base::ParseFlags(argc, argv, &app)) return *code;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    const bool shared = name == "--solve" || name == "--out" || name == "--overwrite";
    if (solved.empty() || shared || option->count() == 0) continue;
    return Fail(absl::InvalidArgumentError(
        absl::StrCat(name, ": expected only --out and --overwrite with --solve, got it")));
  }
  if (!solved.empty()) return RunSolve(solved, options);
  if (options.from.empty()) {
    return Fail(absl::InvalidArgumentError("--from: expected a folder of motion files, got none"));
  }
  ImportReport report;
  const absl::Status status = Import(options, &report);
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
