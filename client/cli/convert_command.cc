#include "client/cli/convert_command.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/flags.h"
#include "client/cli/input_flags.h"
#include "client/cli/motion_input.h"
#include "client/cli/output.h"
#include "client/cli/report.h"
#include "client/cli/rig_flags.h"
#include "client/cli/skeleton_file.h"
#include "model/base/file.h"
#include "model/formats/motion_file.h"
#include "model/motion/resample.h"
#include "model/motion/sbu.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using formats::Format;

// Which people of a file with two people to convert.
enum class People { kLeft, kRight, kBoth };

struct ConvertArguments {
  std::filesystem::path file;
  InputArguments input;
  std::filesystem::path skeleton;  // empty: the 15 joints of sbu
  std::optional<People> people;    // nullopt: all
  std::optional<double> resample_hz;
  std::vector<std::filesystem::path> outputs;
  std::optional<OutputFormat> output_format;  // for standard output
  BvhArguments bvh;
  RigArguments rig;
  bool json = false;
  bool quiet = false;
};

const std::map<std::string, People> kPeople = {
    {"both", People::kBoth}, {"left", People::kLeft}, {"right", People::kRight}};

using Clips = std::vector<motion::Clip>;
using Paths = std::vector<std::filesystem::path>;

// Smaller errors come from rounding.
constexpr double kExactMetres = 2e-5;

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

struct Written {
  Paths files;
  // Largest error of a position that is read back; nullopt on a rig.
  std::optional<double> largest_error_metres = 0;
  std::vector<std::string> missing;  // data that the format cannot store
  std::vector<std::string> notes;
};

absl::Status ChoosePeople(const std::optional<People>& wanted, Clips* people) {
  if (!wanted.has_value()) return absl::OkStatus();
  if (*wanted == People::kBoth) {
    if (people->size() == 2) return absl::OkStatus();
    return absl::InvalidArgumentError(
        "--side: expected left or right for a file with one person, got both");
  }
  // A file of one person is valid for both sides.
  if (*wanted == People::kRight && people->size() > 1) std::swap((*people)[0], (*people)[1]);
  people->resize(1);
  return absl::OkStatus();
}

absl::StatusOr<Conversion> ReadConversion(const ConvertArguments& arguments, std::istream* in) {
  absl::Status status = CheckInput(arguments.file, arguments.input.format);
  if (!status.ok()) return status;
  Conversion conversion;
  absl::StatusOr<motion::Skeleton> skeleton = SkeletonOf(arguments.skeleton);
  if (!skeleton.ok()) return skeleton.status();
  conversion.skeleton = *std::move(skeleton);
  conversion.writing.bvh_metres_per_unit = arguments.bvh.metres_per_unit;
  conversion.writing.bvh_keys_per_frame = arguments.bvh.keys_per_frame;
  absl::StatusOr<formats::ReadOptions> options =
      ToReadOptions(arguments.input, conversion.skeleton);
  if (!options.ok()) return options.status();
  const absl::StatusOr<MotionInput> input = MotionInput::Open(arguments.file, in);
  if (!input.ok()) return input.status();
  absl::StatusOr<formats::ReadPeople> read = ReadAllPeople(*input, *options);
  if (!read.ok()) return read.status();
  conversion.source = input->name();
  conversion.people = std::move(read->people);
  conversion.notes = std::move(read->notes);
  conversion.source_rate_hz = conversion.people[0].frame_rate_hz;
  status = ChoosePeople(arguments.people, &conversion.people);
  for (motion::Clip& person : conversion.people) {
    if (status.ok() && arguments.resample_hz) {
      status = motion::ResampleByRate("--resample", *arguments.resample_hz, &person);
    }
  }
  if (!status.ok()) return status;
  if (!arguments.rig.file.empty() && conversion.people.size() > 1) {
    return absl::InvalidArgumentError(
        "--side: expected left or right with --rig for a file with two people, got both");
  }
  if (arguments.rig.file.empty()) return conversion;
  absl::StatusOr<formats::FollowerRig> rig = ReadRigArguments(arguments.rig, conversion.skeleton);
  if (!rig.ok()) return rig.status();
  conversion.rig = *std::move(rig);
  return conversion;
}

// The largest error of a motion that was written as `content`, in a format that Duet reads.
absl::StatusOr<double> ErrorOf(const std::string& content, Format format, const Clips& people,
                               const Conversion& conversion) {
  formats::ReadOptions options;
  options.format = format;
  options.skeleton = conversion.skeleton;
  options.frame_rate_hz = people[0].frame_rate_hz;
  // SBU text always has the coordinates of the format.
  if (format != Format::kSbuText) options.coordinates = motion::Coordinates{};
  if (format == Format::kBvh) options.metres_per_unit = conversion.writing.bvh_metres_per_unit;
  const int keys = format == Format::kBvh ? conversion.writing.bvh_keys_per_frame : 1;
  double largest = 0;
  for (std::size_t i = 0; i < people.size(); ++i) {
    options.side = i == 0 ? formats::Side::kLeft : formats::Side::kRight;
    const absl::StatusOr<motion::Clip> clip = formats::ParseLeader(content, "the result", options);
    if (!clip.ok()) return clip.status();
    for (int frame = 0; frame < people[i].frame_count(); ++frame) {
      for (int j = 0; j < clip->joint_count(); ++j) {
        const float off = Distance(clip->at(frame * keys, j), people[i].at(frame, j));
        largest = std::max(largest, static_cast<double>(off));
      }
    }
  }
  return largest;
}

std::vector<std::string> MissingIn(Format format, double rate_hz) {
  if (format == Format::kSbuText && rate_hz == motion::kSbuFrameRateHz) return {"joint names"};
  if (format != Format::kNpy && format != Format::kSbuText) return {};
  return {"joint names", absl::StrFormat("the frame rate: read it with --frame-rate %g", rate_hz)};
}

// The content of each file. BVH has one file for each person.
absl::StatusOr<std::vector<std::string>> FormatFiles(const Conversion& conversion, Format format,
                                                     std::optional<double>* largest_error) {
  std::vector<Clips> files = {conversion.people};
  if (format == Format::kBvh && conversion.people.size() == 2) {
    files = {{conversion.people[0]}, {conversion.people[1]}};
  }
  std::vector<std::string> contents;
  for (const Clips& people : files) {
    absl::StatusOr<std::string> content =
        formats::FormatPeople(format, people, conversion.skeleton, conversion.writing);
    if (!content.ok()) return content.status();
    contents.push_back(*std::move(content));
    const absl::StatusOr<double> error = ErrorOf(contents.back(), format, people, conversion);
    if (!error.ok()) return error.status();
    *largest_error = std::max(largest_error->value_or(0), *error);
  }
  return contents;
}

absl::StatusOr<Written> WriteOntoRig(const Conversion& conversion,
                                     const std::filesystem::path& output, Format format) {
  Written written;
  formats::WriteOptions writing = conversion.writing;
  writing.notes = &written.notes;
  formats::FollowerRig rig = *conversion.rig;
  rig.reading.notes = &written.notes;
  const absl::StatusOr<std::string> content =
      formats::FormatOntoRig(conversion.people[0], rig, format, writing);
  if (!content.ok()) return OfRig(content.status());
  absl::Status status = base::WriteFile(output, *content);
  if (!status.ok()) return NotWritten(status);
  written.files = {output};
  written.largest_error_metres.reset();
  return written;
}

absl::StatusOr<Written> Write(const Conversion& conversion, const std::filesystem::path& output,
                              Format format, std::ostream& out) {
  if (conversion.rig) return WriteOntoRig(conversion, output, format);
  Written written;
  const absl::StatusOr<std::vector<std::string>> contents =
      FormatFiles(conversion, format, &written.largest_error_metres);
  if (!contents.ok()) return contents.status();
  written.missing = MissingIn(format, conversion.people[0].frame_rate_hz);
  if (output == kStandardStream) {
    if (contents->size() > 1) {
      return absl::InvalidArgumentError(
          "--out -: BVH has one file for each person. Choose a person with --side");
    }
    absl::Status status = WriteToStream((*contents)[0], out);
    if (!status.ok()) return status;
    written.files = {output};
    return written;
  }
  formats::WriteOptions writing = conversion.writing;
  writing.notes = &written.notes;
  absl::StatusOr<Paths> files =
      formats::WritePeople(output, format, conversion.people, conversion.skeleton, writing);
  if (!files.ok()) return NotWritten(files.status());
  written.files = *std::move(files);
  return written;
}

std::string DescribeExactness(const Written& written) {
  std::string text =
      *written.largest_error_metres < kExactMetres
          ? "every position kept"
          : absl::StrFormat("positions up to %.1f mm off: a bone has one length there",
                            1000 * *written.largest_error_metres);
  if (!written.missing.empty()) {
    absl::StrAppend(&text, "; no place for ", absl::StrJoin(written.missing, " and "));
  }
  return text;
}

std::string Describe(const Conversion& conversion, const std::vector<Written>& written) {
  const motion::Clip& first = conversion.people[0];
  std::string text =
      absl::StrFormat("read      %s: %d %s, %d frames at %g Hz\n", conversion.source,
                      conversion.people.size(), conversion.people.size() == 1 ? "person" : "people",
                      first.frame_count(), first.frame_rate_hz);
  if (first.frame_rate_hz != conversion.source_rate_hz) {
    absl::StrAppendFormat(&text, "          resampled from %g Hz\n", conversion.source_rate_hz);
  }
  for (const std::string& note : conversion.notes) absl::StrAppend(&text, "          ", note, "\n");
  for (const Written& output : written) {
    for (std::size_t i = 0; i < output.files.size(); ++i) {
      absl::StrAppend(
          &text, "wrote     ",
          output.files[i] == kStandardStream ? "standard output" : output.files[i].string(),
          i > 0            ? ""
          : conversion.rig ? absl::StrCat(" (on the rig of ", conversion.rig->file.string(), ")")
                           : absl::StrCat(" (", DescribeExactness(output), ")"),
          "\n");
    }
    for (const std::string& note : output.notes) absl::StrAppend(&text, "          ", note, "\n");
  }
  return text;
}

nlohmann::json ToJson(const Conversion& conversion, const std::vector<Written>& written) {
  nlohmann::json outputs = nlohmann::json::array();
  for (const Written& output : written) {
    nlohmann::json files = nlohmann::json::array();
    for (const std::filesystem::path& file : output.files) files.push_back(file.string());
    nlohmann::json object = {
        {"files", files}, {"no_place_for", output.missing}, {"notes", output.notes}};
    if (output.largest_error_metres) object["largest_error_metres"] = *output.largest_error_metres;
    outputs.push_back(std::move(object));
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
  const absl::StatusOr<Conversion> conversion = ReadConversion(arguments, environment.in);
  if (!conversion.ok()) return conversion.status();
  std::vector<Written> all;
  for (const std::filesystem::path& output : arguments.outputs) {
    const Format format =
        output == kStandardStream ? *arguments.output_format->motion : *formats::FormatOf(output);
    absl::StatusOr<Written> written = Write(*conversion, output, format, *environment.out);
    if (!written.ok()) return written.status();
    all.push_back(*std::move(written));
  }
  if (arguments.quiet) return absl::OkStatus();
  std::ostream& out =
      WritesToStandardOutput(arguments.outputs) ? *environment.err : *environment.out;
  out << (arguments.json ? Print(ToJson(*conversion, all)) : Describe(*conversion, all));
  return absl::OkStatus();
}

void CheckTogether(const FlagSet& command, const ConvertArguments& arguments) {
  CheckStandardOutput(arguments.outputs, arguments.output_format, arguments.json);
  CheckBvhFlags(command, arguments.outputs, arguments.output_format);
  if (arguments.output_format && !arguments.output_format->motion) {
    RejectFlag("--output-format", "html is not a motion format. Use duet view to make a page");
  }
  for (const std::filesystem::path& output : arguments.outputs) {
    const absl::Status status =
        CheckOutput(output, {arguments.file, arguments.rig.file}, PageAllowed::kNo);
    if (!status.ok()) RejectFlag("--out", std::string(status.message()));
  }
  CheckRigFlags(arguments.rig, arguments.outputs);
}

void AddFlags(FlagSet* command, ConvertArguments* arguments) {
  command
      ->Add("file", &arguments->file,
            absl::StrCat("Motion: ", formats::kReadableExtensions, "; - for standard input"))
      ->Required()
      ->Form("FILE");
  AddChoice<People>(
      command, "--side", kPeople, [arguments](People people) { arguments->people = people; },
      "The people to write (default: all)")
      ->Group(kInputGroup);
  AddInputFlags(command, &arguments->input);
  AddSkeletonFlag(command, &arguments->skeleton);
  command
      ->Add("--out", &arguments->outputs,
            "File to write: .glb, .gltf, .bvh (a file for each person), .csv, .npy, "
            ".json or .txt (SBU text); repeatable; - for standard output")
      ->Required()
      ->OneValueEach()
      ->Form("FILE")
      ->Group(kOutputGroup);
  command
      ->Add("--resample", &arguments->resample_hz,
            "Frame rate of the output; the motion keeps its speed (--frame-rate sets the rate "
            "of the input)")
      ->AboveZero()
      ->Form("HZ")
      ->Group(kOutputGroup);
  AddOutputFormatFlag(command, &arguments->output_format);
  AddBvhFlags(command, &arguments->bvh);
  AddRigFlags(command, &arguments->rig);
  command->AddSwitch("--json", &arguments->json, "Print the summary as JSON")->Group(kOutputGroup);
  command->AddSwitch("--quiet", &arguments->quiet, "Print only errors")->Group(kOutputGroup);
  command->Check([command, arguments] { CheckTogether(*command, *arguments); });
}

}  // namespace

Command AddConvertCommand(FlagSet* program) {
  const auto arguments = std::make_shared<ConvertArguments>();
  FlagSet* app =
      program->AddCommand("convert", "Write a motion in another format, with the same positions");
  app->Footer(R"(
Examples:
  duet convert walk.bvh --out walk.glb
  duet convert pair.json --side left --resample 30 --out leader.csv

duet help exit-codes explains the exit codes.
)");
  AddFlags(app, arguments.get());
  return MakeCommand(app, arguments, RunConvert);
}

}  // namespace duet::client::cli
