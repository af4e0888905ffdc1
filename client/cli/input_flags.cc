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
using formats::research::Layout;

const std::map<std::string, Format> kInputFormats = {
    {"amc", Format::kAmc}, {"bvh", Format::kBvh},    {"csv", Format::kCsv},   {"fbx", Format::kFbx},
    {"glb", Format::kGlb}, {"gltf", Format::kGltf},  {"json", Format::kJson}, {"npy", Format::kNpy},
    {"npz", Format::kNpz}, {"sbu", Format::kSbuText}};

const std::map<std::string, OutputFormat> kOutputFormats = {
    {"bvh", {Format::kBvh}},   {"csv", {Format::kCsv}},     {"glb", {Format::kGlb}},
    {"gltf", {Format::kGltf}}, {"html", {std::nullopt}},    {"json", {Format::kJson}},
    {"npy", {Format::kNpy}},   {"sbu", {Format::kSbuText}}, {"usda", {Format::kUsda}}};

const std::map<std::string, Layout> kLayouts = {{"humanml3d", Layout::kHumanMl3d},
                                                {"humanml3d-263", Layout::kHumanMl3dFeatures},
                                                {"inter-x", Layout::kInterX},
                                                {"intergen", Layout::kInterGen},
                                                {"intergen-262", Layout::kInterGenFeatures}};

template <typename Value>
std::vector<std::string> NamesOf(const std::map<std::string, Value>& choices) {
  std::vector<std::string> names;
  for (const auto& choice : choices) names.push_back(choice.first);
  return names;
}

const std::map<std::string, double> kBvhUnits = {{"centimetres", formats::kCentimetre},
                                                 {"metres", 1}};

// Rejects a flag that only `format` needs, with the article and extension `what`.
void CheckOnlyFor(Format format, const char* what, const Flag& flag, const InputArguments& input,
                  const std::vector<std::filesystem::path>& files) {
  if (!flag.is_typed()) return;
  const auto has_format = [&input, format](const std::filesystem::path& file) {
    return (input.format ? input.format : formats::FormatOf(file)) == format;
  };
  if (std::any_of(files.begin(), files.end(), has_format)) return;
  RejectFlag(flag.name(), absl::StrCat("expected ", what, " motion, got ", files.front().string()));
}

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
           "glTF, FBX: the animation (of FBX, a take) of a file with several (default: the first "
           "that moves the person)")
      ->Form("NAME")
      ->Group(kInputGroup);
  AddChoice<Layout>(
      app, "--layout", kLayouts, [input](Layout layout) { input->layout = layout; },
      "Meaning of a .npy array of research: positions of 22 joints, or features")
      ->Group(kInputGroup);
  app->Add("--body-model", &input->body_model,
           "Body model of .npz motions (AMASS, SMPL): an .npz with its joint regressor")
      ->Form("FILE")
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

void CheckInputFlags(const FlagSet& command, const InputArguments& input,
                     const std::vector<std::filesystem::path>& files) {
  CheckOnlyFor(Format::kNpy, "a .npy", *command.Find("--layout"), input, files);
  CheckOnlyFor(Format::kNpz, "a .npz", *command.Find("--body-model"), input, files);
}

std::vector<std::string> InputFormatNames() { return NamesOf(kInputFormats); }
std::vector<std::string> LayoutNames() { return NamesOf(kLayouts); }

void AddOutputFormatFlag(FlagSet* app, std::optional<OutputFormat>* format) {
  AddChoice<OutputFormat>(
      app, "--output-format", kOutputFormats, [format](OutputFormat chosen) { *format = chosen; },
      "Format of standard output (--out -)")
      ->Group(kOutputGroup);
}

void AddOutputLayoutFlag(FlagSet* app, std::optional<Layout>* layout) {
  AddChoice<Layout>(
      app, "--output-layout", kLayouts, [layout](Layout chosen) { *layout = chosen; },
      "Layout of --out FILE.npy: 22 joints of a body model at the rate of the data set")
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
