#include "client/cli/input_flags.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "client/cli/flags.h"
#include "client/cli/value_syntax.h"

namespace duet::client::cli {
namespace {

using formats::Format;

const std::map<std::string, Format> kInputFormats = {
    {"amc", Format::kAmc}, {"bvh", Format::kBvh},    {"csv", Format::kCsv},
    {"glb", Format::kGlb}, {"gltf", Format::kGltf},  {"json", Format::kJson},
    {"npy", Format::kNpy}, {"sbu", Format::kSbuText}};

const std::map<std::string, OutputFormat> kOutputFormats = {
    {"bvh", {Format::kBvh}},   {"csv", {Format::kCsv}},     {"glb", {Format::kGlb}},
    {"gltf", {Format::kGltf}}, {"html", {std::nullopt}},    {"json", {Format::kJson}},
    {"npy", {Format::kNpy}},   {"sbu", {Format::kSbuText}}, {"usda", {Format::kUsda}}};

const std::map<std::string, double> kBvhUnits = {{"centimetres", formats::kCentimetre},
                                                 {"metres", 1}};

}  // namespace

const std::map<std::string, formats::Side> kSides = {{"left", formats::Side::kLeft},
                                                     {"right", formats::Side::kRight}};

void AddInputFlags(CLI::App* app, InputArguments* input) {
  AddChoice<Format>(
      app, "--input-format", kInputFormats, [input](Format format) { input->format = format; },
      "What is read, where no name tells it (-); replaces the extension")
      ->group(kInputGroup);
  app->add_option("--frame-rate", input->frame_rate_hz, "Replaces what the file says")
      ->check(AboveZero())
      ->type_name("HZ")
      ->group(kInputGroup);
  AddParsed<motion::LengthUnit>(
      app, "--unit", "metres|millimetres|sbu-normalised", ParseUnit,
      [input](motion::LengthUnit unit) { input->unit = unit; },
      "Unit of positions; replaces what the file says")
      ->take_last()
      ->group(kInputGroup);
  AddParsed<motion::UpAxis>(
      app, "--up-axis", "y-up|z-up|y-down", ParseAxis,
      [input](motion::UpAxis axis) { input->up_axis = axis; },
      "Up axis of positions; replaces what the file says")
      ->take_last()
      ->group(kInputGroup);
  app->add_option("--metres-per-unit", input->metres_per_unit,
                  "BVH, glTF, ASF: metres in one unit of the file (0.01 for centimetres)")
      ->check(AboveZero())
      ->type_name("METRES")
      ->group(kInputGroup);
  AddParsed<std::pair<std::string, std::string>>(
      app, "--joint-map", "MODEL_JOINT=FILE_JOINT", ParseJointPair,
      [input](std::pair<std::string, std::string> joints) { input->joints.insert(joints); },
      "Where names alone do not tell which is which; repeatable")
      ->group(kInputGroup);
  app->add_option("--joint-map-file", input->joint_table,
                  "A table of such joints, one MODEL_JOINT=FILE_JOINT a line; --joint-map wins")
      ->type_name("FILE")
      ->group(kInputGroup);
}

void AddOutputFormatFlag(CLI::App* app, std::optional<OutputFormat>* format) {
  AddChoice<OutputFormat>(
      app, "--output-format", kOutputFormats, [format](OutputFormat chosen) { *format = chosen; },
      "What is written to standard output (--out -)")
      ->group(kOutputGroup);
}

void AddBvhFlags(CLI::App* app, BvhArguments* bvh) {
  AddChoice<double>(
      app, "--bvh-unit", kBvhUnits, [bvh](double metres) { bvh->metres_per_unit = metres; },
      "Unit of .bvh that is written, which the format does not tell: centimetres as Maya, "
      "MotionBuilder and Unreal take it, metres as Blender does")
      ->default_str("centimetres")
      ->group(kOutputGroup);
  app->add_option("--bvh-keys-per-frame", bvh->keys_per_frame,
                  "Keys in .bvh for each frame of the motion: with more, programs that draw lines "
                  "from angle to angle stay near the motion where a joint passes gimbal lock")
      ->check(Undescribed(CLI::Range(1, formats::kMostBvhKeysPerFrame)))
      ->capture_default_str()
      ->type_name("COUNT")
      ->group(kOutputGroup);
}

bool WritesToStandardOutput(const std::vector<std::filesystem::path>& outputs) {
  return std::find(outputs.begin(), outputs.end(), kStandardStream) != outputs.end();
}

void CheckStandardOutput(const std::vector<std::filesystem::path>& outputs,
                         const std::optional<OutputFormat>& format, bool json) {
  const auto count = std::count(outputs.begin(), outputs.end(), kStandardStream);
  if (count == 0) {
    if (!format.has_value()) return;
    throw CLI::ValidationError("--output-format", "counts for --out - alone, which is not there");
  }
  if (count > 1) throw CLI::ValidationError("--out", "- came twice, wanted once");
  if (!format.has_value()) throw CLI::RequiredError("--output-format, which --out - needs,");
  if (json) throw CLI::ValidationError("--json", "and --out - both print to standard output");
}

}  // namespace duet::client::cli
