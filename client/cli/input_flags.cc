#include "client/cli/input_flags.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/flags.h"
#include "client/cli/value_syntax.h"

namespace duet::client::cli {
namespace {

using formats::Format;

const std::map<std::string, Format> kInputFormats = {
    {"bvh", Format::kBvh},    {"csv", Format::kCsv},   {"glb", Format::kGlb},
    {"gltf", Format::kGltf},  {"json", Format::kJson}, {"npy", Format::kNpy},
    {"sbu", Format::kSbuText}};

const std::map<std::string, OutputFormat> kOutputFormats = {
    {"bvh", {Format::kBvh}},   {"csv", {Format::kCsv}},    {"glb", {Format::kGlb}},
    {"gltf", {Format::kGltf}}, {"html", {std::nullopt}},   {"json", {Format::kJson}},
    {"npy", {Format::kNpy}},   {"sbu", {Format::kSbuText}}};

template <typename Value>
std::vector<std::string> NamesOf(const std::map<std::string, Value>& choices) {
  std::vector<std::string> names;
  for (const auto& choice : choices) names.push_back(choice.first);
  return names;
}

const std::map<std::string, double> kBvhUnits = {{"centimetres", formats::kCentimetre},
                                                 {"metres", 1}};

}  // namespace

const std::map<std::string, formats::Side> kSides = {{"left", formats::Side::kLeft},
                                                     {"right", formats::Side::kRight}};

void AddInputFlags(FlagSet* app, InputArguments* input) {
  AddChoice<Format>(
      app, "--input-format", kInputFormats, [input](Format format) { input->format = format; },
      "Format of the input; required for standard input (-), overrides the extension")
      ->Group(kInputGroup);
  app->Add("--frame-rate", &input->frame_rate_hz, "Frame rate of the input; overrides the file")
      ->AboveZero()
      ->Form("HZ")
      ->Group(kInputGroup);
  AddParsed<motion::LengthUnit>(
      app, "--unit", "metres|millimetres|sbu-normalised", ParseUnit,
      [input](motion::LengthUnit unit) { input->unit = unit; },
      "Unit of positions; overrides the file")
      ->LastOnly()
      ->Group(kInputGroup);
  AddParsed<motion::UpAxis>(
      app, "--up-axis", "y-up|z-up|y-down", ParseAxis,
      [input](motion::UpAxis axis) { input->up_axis = axis; },
      "Up axis of positions; overrides the file")
      ->LastOnly()
      ->Group(kInputGroup);
  app->Add("--metres-per-unit", &input->metres_per_unit,
           "Metres in one unit of the file (0.01 for centimetres); overrides --unit")
      ->AboveZero()
      ->Form("METRES")
      ->Group(kInputGroup);
  app->Add("--animation", &input->animation,
           "glTF: the animation of a file with several (default: the first that moves the person)")
      ->Form("NAME")
      ->Group(kInputGroup);
  AddParsed<std::pair<std::string, std::string>>(
      app, "--joint-map", "MODEL_JOINT=FILE_JOINT", ParseJointPair,
      [input](std::pair<std::string, std::string> joints) {
        input->joints.insert(std::move(joints));
      },
      "Joint of the file for a joint of the model, if its name is not recognised; repeatable")
      ->Group(kInputGroup);
  app->Add("--joint-map-file", &input->joint_table,
           "File with one MODEL_JOINT=FILE_JOINT on each line; --joint-map overrides it")
      ->Form("FILE")
      ->Group(kInputGroup);
}

std::vector<std::string> InputFormatNames() { return NamesOf(kInputFormats); }

void AddOutputFormatFlag(FlagSet* app, std::optional<OutputFormat>* format) {
  AddChoice<OutputFormat>(
      app, "--output-format", kOutputFormats, [format](OutputFormat chosen) { *format = chosen; },
      "Format of standard output (--out -)")
      ->Group(kOutputGroup);
}

void AddBvhFlags(FlagSet* app, BvhArguments* bvh) {
  AddChoice<double>(
      app, "--bvh-unit", kBvhUnits, [bvh](double metres) { bvh->metres_per_unit = metres; },
      "Unit of .bvh output, which the format does not state: Maya, MotionBuilder and Unreal "
      "expect centimetres, Blender metres")
      ->ShowDefault("centimetres")
      ->Group(kOutputGroup);
  app->Add("--bvh-keys-per-frame", &bvh->keys_per_frame,
           "Keys in .bvh for each frame of the motion; more keep programs that interpolate "
           "angles linearly close to the motion near gimbal lock")
      ->InRange(1, formats::kMostBvhKeysPerFrame)
      ->ShowDefault()
      ->Form("COUNT")
      ->Group(kOutputGroup);
}

void CheckBvhFlags(const FlagSet& command, const std::vector<std::filesystem::path>& outputs,
                   const std::optional<OutputFormat>& format) {
  if (WritesFormat(Format::kBvh, outputs, format)) return;
  const auto append = [](std::string* out, const std::filesystem::path& path) {
    out->append(path.string());
  };
  for (const char* name : {"--bvh-unit", "--bvh-keys-per-frame"}) {
    if (!command.Find(name)->is_typed()) continue;
    RejectFlag(name, absl::StrCat("expected an output FILE.bvh, got ",
                                  absl::StrJoin(outputs, ", ", append)));
  }
}

bool WritesFormat(Format wanted, const std::vector<std::filesystem::path>& outputs,
                  const std::optional<OutputFormat>& format) {
  const auto has_format = [wanted, &format](const std::filesystem::path& output) {
    if (output != kStandardStream) return formats::FormatOf(output) == wanted;
    return format && format->motion == wanted;
  };
  return std::any_of(outputs.begin(), outputs.end(), has_format);
}

bool WritesToStandardOutput(const std::vector<std::filesystem::path>& outputs) {
  return std::find(outputs.begin(), outputs.end(), kStandardStream) != outputs.end();
}

void CheckStandardOutput(const std::vector<std::filesystem::path>& outputs,
                         const std::optional<OutputFormat>& format, bool json) {
  const auto count = std::count(outputs.begin(), outputs.end(), kStandardStream);
  if (count == 0) {
    if (!format.has_value()) return;
    RejectFlag("--output-format", "is only valid with --out -");
  }
  if (count > 1) RejectFlag("--out", "expected - once, got it twice");
  if (!format.has_value()) RejectMissing("--output-format, which --out - needs,");
  if (json) RejectFlag("--json", "cannot be used with --out -: both print to standard output");
}

}  // namespace duet::client::cli
