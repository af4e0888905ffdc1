#include "model/checkpoint/paper_architecture.h"

#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "model/checkpoint/architecture_json.h"
#include "model/checkpoint/manifest.h"
#include "model/checkpoint/names.h"

namespace duet::checkpoint {
namespace {

constexpr char kWholeBody[] = "whole_body";
constexpr int kCoordinates = 3;
// Far above any use, and low enough that a small file cannot ask for a huge network.
constexpr int kMaxUnits = 4096;

int WholeBodyInput(const Manifest& manifest, const PaperArchitecture& paper) {
  const motion::Skeleton& skeleton = manifest.model.skeleton;
  int input = 0;
  if (paper.variant != GeneratorVariant::kUnlabelled) input += manifest.model.class_count();
  if (paper.variant != GeneratorVariant::kReleased) input += kCoordinates * skeleton.joint_count();
  if (paper.follower_start) input += StartFeatureCount(skeleton);
  return input;
}

}  // namespace

void ReadFields(base::ObjectReader* reader, PaperArchitecture* out) {
  out->variant = ReadNamed(reader, "variant", kVariantNames);
  out->follower_start = reader->Bool("follower_start");
  out->slice_features = static_cast<int>(reader->Int("slice_features", 0, kMaxUnits));
  out->encoder_hidden = static_cast<int>(reader->Int("encoder_hidden", 1, kMaxUnits));
  out->attention = static_cast<int>(reader->Int("attention", 1, kMaxUnits));
  out->base_pose = reader->Bool("base_pose");
}

nlohmann::ordered_json ToJson(const PaperArchitecture& paper) {
  return {{"variant", std::string(NameOf(kVariantNames, paper.variant))},
          {"follower_start", paper.follower_start},
          {"slice_features", paper.slice_features},
          {"encoder_hidden", paper.encoder_hidden},
          {"attention", paper.attention},
          {"base_pose", paper.base_pose},
          {kArchitectureKind, PaperArchitecture::kKind}};
}

std::vector<SliceShape> SliceShapes(const Manifest& manifest) {
  const auto& paper = std::get<PaperArchitecture>(manifest.architecture);
  std::vector<SliceShape> slices;
  for (const motion::BodyPart& part : manifest.parts) {
    slices.push_back({part.name, kCoordinates * static_cast<int>(part.joints.size()), 0});
  }
  slices.push_back({kWholeBody, WholeBodyInput(manifest, paper), 0});
  for (SliceShape& slice : slices) slice.features = slice.input + paper.slice_features;
  return slices;
}

std::vector<TensorSpec> Tensors(const Manifest& manifest, const PaperArchitecture& paper) {
  const std::vector<SliceShape> slices = SliceShapes(manifest);
  const int64_t encoder = paper.encoder_hidden;
  const int64_t attention = paper.attention;
  const int64_t state = static_cast<int64_t>(slices.size()) * encoder;  // of one decoder direction
  const int64_t encoded = 2 * state;
  const int64_t outputs = int64_t{kCoordinates} * manifest.model.skeleton.joint_count();

  std::vector<TensorSpec> specs;
  for (const SliceShape& slice : slices) {
    const std::string at = absl::StrCat("encoder.", slice.name, ".");
    if (paper.slice_features > 0) {
      specs.push_back({at + "fc.weight", {slice.features, slice.input}});
      specs.push_back({at + "fc.bias", {slice.features}});
    }
    for (const char* direction : {"forward", "backward"}) {
      specs.push_back({absl::StrCat(at, direction, ".weight_ih"), {4 * encoder, slice.features}});
      specs.push_back({absl::StrCat(at, direction, ".weight_hh"), {4 * encoder, encoder}});
      specs.push_back({absl::StrCat(at, direction, ".bias"), {4 * encoder}});
    }
  }
  for (const char* direction : {"forward", "backward"}) {
    const std::string at = absl::StrCat("decoder.", direction, ".");
    specs.push_back({at + "attention_encoded", {attention, encoded}});
    specs.push_back({at + "attention_state", {attention, state}});
    specs.push_back({at + "attention_score", {attention}});
    specs.push_back({at + "weight_ih", {4 * state, encoded}});
    specs.push_back({at + "weight_hh", {4 * state, state}});
    specs.push_back({at + "bias", {4 * state}});
  }
  specs.push_back({"output.weight", {outputs, encoded}});
  specs.push_back({"output.bias", {outputs}});
  if (paper.base_pose) {
    if (paper.variant != GeneratorVariant::kUnlabelled) {
      specs.push_back({"base.weight", {outputs, manifest.model.class_count()}});
    }
    specs.push_back({"base.bias", {outputs}});
  }
  return specs;
}

}  // namespace duet::checkpoint
