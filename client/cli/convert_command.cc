#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/batch/text_values.h"
#include "client/cli/command.h"
#include "client/cli/flags.h"
#include "client/cli/motion_input.h"
#include "client/cli/output.h"
#include "model/base/file.h"
#include "model/formats/motion_file.h"
#include "model/motion/reading_setting.h"
#include "model/motion/resample.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using formats::Format;

// The rig that a person is written onto, and how to read its file.
struct RigArguments {
  std::filesystem::path file;  // empty: Duet's own rig
  formats::Side side = kDefaultSide;
  InputArguments reading;
};

struct ConvertArguments {
  std::filesystem::path file;
  InputArguments input;
  std::filesystem::path skeleton;     // empty: the 15 joints of sbu
  std::optional<formats::Side> side;  // nullopt: all people
  std::optional<double> resample_hz;
  std::vector<std::filesystem::path> outputs;
  double bvh_metres_per_unit = formats::kCentimetre;
  RigArguments rig;
  bool json = false;
  bool quiet = false;
};

absl::StatusOr<double> ParseBvhUnit(absl::string_view text) {
  if (text == "centimetres") return formats::kCentimetre;
  if (text == "metres") return 1;
  return batch::Expected("centimetres or metres", text);
}

using Clips = std::vector<motion::Clip>;
using Paths = std::vector<std::filesystem::path>;

struct WrittenFiles {
  Paths files;
  std::vector<std::string> notes;  // remarks on them
};

// A motion to write.
struct Conversion {
  std::string source;
  Clips people;
  motion::Skeleton skeleton;
  std::vector<std::string> notes;
  double source_rate_hz = 0;
  formats::WriteOptions writing;
  std::optional<formats::FollowerRig> rig;
};

// A file of one person is valid for both sides.
void ChoosePerson(formats::Side side, Clips* people) {
  if (side == formats::Side::kRight && people->size() > 1) std::swap((*people)[0], (*people)[1]);
  people->resize(1);
}

absl::StatusOr<formats::FollowerRig> ReadRig(const RigArguments& arguments,
                                             const motion::Skeleton& skeleton) {
  absl::StatusOr<formats::ReadOptions> reading = ToReadOptions(arguments.reading, skeleton);
  if (!reading.ok()) return reading.status();
  reading->side = arguments.side;
  return formats::FollowerRig{arguments.file, *std::move(reading)};
}

absl::StatusOr<Conversion> ReadConversion(const ConvertArguments& arguments) {
  Conversion conversion;
  absl::StatusOr<motion::Skeleton> skeleton = SkeletonOf(arguments.skeleton);
  if (!skeleton.ok()) return skeleton.status();
  conversion.skeleton = *std::move(skeleton);
  conversion.writing.bvh_metres_per_unit = arguments.bvh_metres_per_unit;
  absl::StatusOr<formats::ReadOptions> options =
      ToReadOptions(arguments.input, conversion.skeleton);
  if (!options.ok()) return options.status();
  absl::StatusOr<ReadPeople> read = ReadAllPeople(arguments.file, *options);
  if (!read.ok()) return read.status();
  conversion.source = arguments.file.string();
  conversion.people = std::move(read->people);
  conversion.notes = std::move(read->notes);
  conversion.source_rate_hz = conversion.people[0].frame_rate_hz;
  if (arguments.side) ChoosePerson(*arguments.side, &conversion.people);
  for (motion::Clip& person : conversion.people) {
    if (!arguments.resample_hz) break;
    absl::Status status = motion::ResampleByRate("--resample", *arguments.resample_hz, &person);
    if (!status.ok()) return status;
  }
  if (!arguments.rig.file.empty() && conversion.people.size() > 1) {
    return absl::InvalidArgumentError(
        "--side: expected left or right with --rig for a file with two people, got both");
  }
  if (arguments.rig.file.empty()) return conversion;
  absl::StatusOr<formats::FollowerRig> rig = ReadRig(arguments.rig, conversion.skeleton);
  if (!rig.ok()) return rig.status();
  conversion.rig = *std::move(rig);
  return conversion;
}

absl::StatusOr<WrittenFiles> WriteOntoRig(const Conversion& conversion,
                                          const std::filesystem::path& output, Format format) {
  WrittenFiles written{{output}, {}};
  formats::FollowerRig rig = *conversion.rig;
  retargeting::ReadingReport report;
  rig.reading.report = &report;
  const absl::StatusOr<std::string> content =
      formats::FormatOntoRig(conversion.people[0], rig, format);
  if (motion::MendingSetting(content.status()) == motion::ReadingSetting::kJointMap) {
    return MendedBy(content.status(), motion::ReadingSetting::kRigJointMap);
  }
  if (!content.ok()) return content.status();
  written.notes = report.Notes();
  const absl::Status status = base::WriteFile(output, *content);
  if (!status.ok()) return NotWritten(status);
  return written;
}

absl::StatusOr<WrittenFiles> Write(const Conversion& conversion,
                                   const std::filesystem::path& output) {
  const Format format = *formats::FormatOf(output);
  if (conversion.rig) return WriteOntoRig(conversion, output, format);
  absl::StatusOr<Paths> files = formats::WritePeople(output, format, conversion.people,
                                                     conversion.skeleton, conversion.writing);
  if (!files.ok()) return NotWritten(files.status());
  return WrittenFiles{*std::move(files), {}};
}

std::string Describe(const Conversion& conversion, const std::vector<WrittenFiles>& written) {
  const motion::Clip& first = conversion.people[0];
  std::string text =
      absl::StrFormat("read      %s: %d %s, %d frames at %g Hz\n", conversion.source,
                      conversion.people.size(), conversion.people.size() == 1 ? "person" : "people",
                      first.frame_count(), first.frame_rate_hz);
  if (first.frame_rate_hz != conversion.source_rate_hz) {
    absl::StrAppendFormat(&text, "          resampled from %g Hz\n", conversion.source_rate_hz);
  }
  for (const std::string& note : conversion.notes) absl::StrAppend(&text, "          ", note, "\n");
  for (const WrittenFiles& output : written) {
    for (const std::filesystem::path& file : output.files) {
      absl::StrAppend(&text, "wrote     ", file.string(),
                      conversion.rig
                          ? absl::StrCat(" (on the rig of ", conversion.rig->file.string(), ")")
                          : "",
                      "\n");
    }
    for (const std::string& note : output.notes) absl::StrAppend(&text, "          ", note, "\n");
  }
  return text;
}

nlohmann::json ToJson(const Conversion& conversion, const std::vector<WrittenFiles>& written) {
  nlohmann::json outputs = nlohmann::json::array();
  for (const WrittenFiles& output : written) {
    nlohmann::json files = nlohmann::json::array();
    for (const std::filesystem::path& file : output.files) files.push_back(file.string());
    outputs.push_back({{"files", files}, {"notes", output.notes}});
  }
  return {{"file", conversion.source},
          {"people_count", conversion.people.size()},
          {"frames", conversion.people[0].frame_count()},
          {"frame_rate_hz", conversion.people[0].frame_rate_hz},
          {"source_frame_rate_hz", conversion.source_rate_hz},
          {"notes", conversion.notes},
          {"outputs", outputs}};
}

absl::Status RunConvert(const ConvertArguments& arguments, const ProgramEnvironment& environment) {
  const absl::StatusOr<Conversion> conversion = ReadConversion(arguments);
  if (!conversion.ok()) return conversion.status();
  std::vector<WrittenFiles> all;
  for (const std::filesystem::path& output : arguments.outputs) {
    absl::StatusOr<WrittenFiles> written = Write(*conversion, output);
    if (!written.ok()) return written.status();
    all.push_back(*std::move(written));
  }
  if (arguments.quiet) return absl::OkStatus();
  *environment.out << (arguments.json ? Print(ToJson(*conversion, all))
                                      : Describe(*conversion, all));
  return absl::OkStatus();
}

// Checks that every output has the rig's format.
void CheckRig(const ConvertArguments& arguments) {
  if (arguments.rig.file.empty()) return;
  const std::optional<Format> format = formats::FormatOf(arguments.rig.file);
  if (!format || !formats::HasRig(*format)) {
    RejectFlag("--rig", absl::StrCat("expected ", formats::kRigExtensions, ", got ",
                                     arguments.rig.file.string()));
  }
  for (const std::filesystem::path& output : arguments.outputs) {
    const std::optional<Format> written = formats::FormatOf(output);
    if (written && formats::FitsRig(*written, *format)) continue;
    RejectFlag("--out", absl::StrCat("expected the format of --rig, got ", output.string()));
  }
}

void CheckTogether(const ConvertArguments& arguments) {
  for (const std::filesystem::path& output : arguments.outputs) {
    const absl::Status status =
        CheckOutput(output, {arguments.file, arguments.rig.file}, OutputKind::kMotion);
    if (!status.ok()) RejectFlag("--out", std::string(status.message()));
  }
  CheckRig(arguments);
}

void AddRigFlags(CLI::App* app, RigArguments* rig) {
  CLI::Option* file =
      AddValue(app, kOutputGroup, "--rig", "FILE", &rig->file,
               absl::StrCat("File whose rig the person is written onto, ", formats::kRigExtensions,
                            "; --out has its format (default: Duet's rig)"));
  AddParsed(app, kOutputGroup, "--rig-side", "left|right", batch::ParseSide, &rig->side,
            "The person in a --rig file with two people")
      ->default_str("left")
      ->needs(file);
  AddParsed(app, kOutputGroup, "--rig-up-axis", "y-up|z-up|y-down", ParseAxis,
            &rig->reading.up_axis, "Up axis of the rig; overrides the file")
      ->needs(file);
  AddValue(app, kOutputGroup, "--rig-metres-per-unit", "METRES", &rig->reading.metres_per_unit,
           "Metres in one unit of the rig (0.01 for centimetres)")
      ->check(AboveZero())
      ->needs(file);
  AddValue(app, kOutputGroup, "--rig-joint-map", "MODEL_JOINT=RIG_JOINT|FILE",
           &rig->reading.joint_map,
           "Joint of the rig for a joint of the model, if its name is not recognised, or a file "
           "with one such pair on each line; repeatable")
      ->allow_extra_args(false)
      ->needs(file);
}

void AddFlags(CLI::App* command, ConvertArguments* arguments) {
  command
      ->add_option("file", arguments->file, absl::StrCat("Motion: ", formats::kReadableExtensions))
      ->required()
      ->type_name("FILE");
  AddParsed(command, kInputGroup, "--side", "left|right", batch::ParseSide, &arguments->side,
            "The person to write (default: all)");
  AddInputFlags(command, &arguments->input);
  AddSkeletonFlag(command, &arguments->skeleton);
  AddValue(command, kOutputGroup, "--out", "FILE", &arguments->outputs,
           absl::StrCat("File to write: ", formats::kWritableExtensions,
                        ", of which .bvh makes a file for each person; repeatable"))
      ->required()
      ->allow_extra_args(false);
  AddValue(command, kOutputGroup, "--resample", "HZ", &arguments->resample_hz,
           "Frame rate of the output; the motion keeps its speed (--frame-rate sets the rate "
           "of the input)")
      ->check(AboveZero());
  AddParsed(command, kOutputGroup, "--bvh-unit", "centimetres|metres", ParseBvhUnit,
            &arguments->bvh_metres_per_unit,
            "Unit of .bvh output, which the format does not state: Maya, MotionBuilder and Unreal "
            "expect centimetres, Blender metres")
      ->default_str("centimetres");
  AddRigFlags(command, &arguments->rig);
  AddSummaryFlags(command, kOutputGroup, &arguments->json, &arguments->quiet);
  command->callback([arguments] { CheckTogether(*arguments); });
}

}  // namespace

Command AddConvertCommand(CLI::App* program) {
  const auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* app = program->add_subcommand(
      "convert", "Write a motion in another format, with the same positions");
  app->footer(R"(
Examples:
  duet convert walk.bvh --out walk.glb
  duet convert pair.json --side left --resample 30 --out leader.csv
)");
  AddFlags(app, arguments.get());
  return MakeCommand(app, arguments, RunConvert);
}

}  // namespace duet::client::cli
