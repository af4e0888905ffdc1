#include "client/cli/motion_flags.h"

#include <cstddef>
#include <map>
#include <string>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "client/cli/flags.h"
#include "client/cli/input_flags.h"
#include "client/cli/output.h"

namespace duet::client::cli {
namespace {

const std::map<std::string, People> kPeople = {
    {"both", People::kBoth}, {"left", People::kLeft}, {"right", People::kRight}};

constexpr char kTakesFooter[] = R"(
Each FILE is a motion of one or two people: FILE, NAME=FILE, or LEADER.bvh,FOLLOWER.bvh
(walk.leader.bvh finds its walk.follower.bvh by itself).
)";

// How the takes of a file with two people are read.
void AddTakeFlags(CLI::App* app, TakeArguments* takes) {
  app->add_option_function<std::vector<std::string>>(
         "--leader-side",
         [takes](const std::vector<std::string>& sides) {
           takes->leader_sides.clear();
           for (const std::string& side : sides) takes->leader_sides.push_back(kSides.at(side));
         },
         "Which person of a file with two leads; once for all files, or once for each")
      ->check(Undescribed(CLI::IsMember(std::vector<std::string>{"left", "right"})))
      ->allow_extra_args(false)
      ->type_name("left|right")
      ->default_str("left")
      ->group(kInputGroup);
  AddInputFlags(app, &takes->input);
}

void CheckTakes(const TakeArguments& takes) {
  const std::size_t sides = takes.leader_sides.size();
  if (sides != 1 && sides != takes.takes.size()) {
    throw CLI::ValidationError(
        "--leader-side",
        absl::StrCat("came ", sides, " times, wanted once or ", takes.takes.size(), " times"));
  }
  int pipes = 0;
  for (const std::string& take : takes.takes) pipes += take == kStandardStream ? 1 : 0;
  if (pipes > 1) throw CLI::ValidationError("FILE", "- came twice, wanted once");
}

void CheckPage(const char* flag, const std::filesystem::path& page) {
  if (page == kStandardStream) return;
  const std::string extension = absl::AsciiStrToLower(page.extension().string());
  if (extension != ".html" && extension != ".htm") {
    throw CLI::ValidationError(
        flag, absl::StrCat(page.string(), ": extension: came \"", extension, "\", wanted .html"));
  }
  const absl::Status status = CheckOutput(page, "");
  if (!status.ok()) throw CLI::ValidationError(flag, std::string(status.message()));
}

void CheckTogether(const ConvertArguments& arguments) {
  CheckStandardOutput(arguments.outputs, arguments.output_format, arguments.json);
  if (arguments.output_format && !arguments.output_format->motion) {
    throw CLI::ValidationError("--output-format",
                               "html is no motion; duet view makes a page of motions");
  }
  for (const std::filesystem::path& output : arguments.outputs) {
    const absl::Status status = CheckOutput(output, arguments.file, PageAllowed::kNo);
    if (!status.ok()) throw CLI::ValidationError("--out", std::string(status.message()));
  }
}

}  // namespace

CLI::App* AddInspectCommand(CLI::App* app, InspectArguments* arguments) {
  CLI::App* command = app->add_subcommand(
      "inspect", "Tell what is in motion files, how they are understood, and what looks wrong");
  command
      ->add_option(
          "files", arguments->files,
          "Motions: .bvh, .gltf, .glb, .amc, .csv, .npy, .json or SBU .txt; - for standard "
          "input")
      ->required()
      ->type_name("FILE");
  AddInputFlags(command, &arguments->input);
  command->add_flag("--json", arguments->json, "Print JSON")->group(kOutputGroup);
  return command;
}

CLI::App* AddConvertCommand(CLI::App* app, ConvertArguments* arguments) {
  CLI::App* command =
      app->add_subcommand("convert", "Write a motion in another format, positions as they are");
  command
      ->add_option("file", arguments->file,
                   "Motion: .bvh, .gltf, .glb, .amc, .csv, .npy, .json or SBU .txt; - for standard "
                   "input")
      ->required()
      ->type_name("FILE");
  AddChoice<People>(
      command, "--side", kPeople, [arguments](People people) { arguments->people = people; },
      "Who is written of a file with two people (default: all)")
      ->group(kInputGroup);
  AddInputFlags(command, &arguments->input);
  command
      ->add_option("--out", arguments->outputs,
                   "File to write: .glb, .gltf, .usda, .bvh (a file for each person), .csv, .npy, "
                   ".json or .txt "
                   "(SBU text); repeatable; - for standard output")
      ->required()
      ->allow_extra_args(false)
      ->type_name("FILE")
      ->group(kOutputGroup);
  command
      ->add_option("--resample", arguments->resample_hz,
                   "Frames a second of what is written; the motion keeps its pace (--frame-rate "
                   "says what the file has)")
      ->check(AboveZero())
      ->type_name("HZ")
      ->group(kOutputGroup);
  AddOutputFormatFlag(command, &arguments->output_format);
  AddBvhFlags(command, &arguments->bvh);
  command->add_flag("--json", arguments->json, "Print the summary as JSON")->group(kOutputGroup);
  command->add_flag("--quiet", arguments->quiet, "Print errors alone")->group(kOutputGroup);
  command->callback([arguments] { CheckTogether(*arguments); });
  return command;
}

CLI::App* AddViewCommand(CLI::App* app, ViewArguments* arguments) {
  CLI::App* command = app->add_subcommand("view", "Make a page that plays motions side by side");
  command->add_option("files", arguments->takes.takes, "Motions to show, at most 12")
      ->required()
      ->expected(1, 12)
      ->type_name("[NAME=]FILE");
  AddTakeFlags(command, &arguments->takes);
  command->add_option("--out", arguments->out, "Page to write, .html; - for standard output")
      ->required()
      ->type_name("FILE")
      ->group(kOutputGroup);
  command->add_option("--title", arguments->title, "What the page is called")
      ->type_name("TEXT")
      ->group(kOutputGroup);
  command->add_flag("--quiet", arguments->quiet, "Print errors alone")->group(kOutputGroup);
  command->footer(kTakesFooter);
  command->callback([arguments] {
    CheckTakes(arguments->takes);
    CheckPage("--out", arguments->out);
  });
  return command;
}

CLI::App* AddCompareCommand(CLI::App* app, CompareArguments* arguments) {
  CLI::App* command = app->add_subcommand(
      "compare", "Tell how two motions differ: displacement, speed, lean, contact");
  command
      ->add_option("files", arguments->takes.takes,
                   "The two motions; of two people each, their followers are compared")
      ->required()
      ->expected(2)
      ->type_name("[NAME=]FILE");
  AddTakeFlags(command, &arguments->takes);
  command->add_flag("--json", arguments->json, "Print JSON")->group(kOutputGroup);
  command
      ->add_option("--out", arguments->out,
                   "Page to write with both motions and all figures, .html")
      ->type_name("FILE")
      ->group(kOutputGroup);
  command->footer(kTakesFooter);
  command->callback([arguments] {
    CheckTakes(arguments->takes);
    if (arguments->out == kStandardStream) {
      throw CLI::ValidationError("--out", "expected a file, got standard output");
    }
    if (!arguments->out.empty()) CheckPage("--out", arguments->out);
  });
  return command;
}

}  // namespace duet::client::cli
