#include "absl/strings/str_cat.h"
#include "model/checkpoint/flow_tensor_table.h"
#include "model/checkpoint/manifest.h"

namespace duet::checkpoint {
namespace {

constexpr char kWholeBody[] = "whole_body";
constexpr int kCoordinates = 3;
constexpr int kStartFlags = 2;  // root known, pose known

int WholeBodyInput(const Manifest& manifest) {
  const motion::Skeleton& skeleton = manifest.model.skeleton;
  int input = 0;
  if (manifest.generator.variant != GeneratorVariant::kUnlabelled)
    input += manifest.model.class_count();
  if (manifest.generator.variant != GeneratorVariant::kReleased)
    input += kCoordinates * skeleton.joint_count();
  if (manifest.generator.follower_start) input += StartFeatureCount(skeleton);
  return input;
}

}  // namespace

int StartFeatureCount(const motion::Skeleton& skeleton) {
  return kCoordinates + kCoordinates * skeleton.joint_count() + kStartFlags;
}

std::vector<SliceShape> SliceShapes(const Manifest& manifest) {
  std::vector<SliceShape> slices;
  for (const motion::BodyPart& part : manifest.generator.parts) {
    slices.push_back({part.name, kCoordinates * static_cast<int>(part.joints.size()), 0});
  }
  slices.push_back({kWholeBody, WholeBodyInput(manifest), 0});
  for (SliceShape& slice : slices) {
    slice.features = slice.input + manifest.generator.slice_features;
  }
  return slices;
}

std::vector<TensorSpec> ExpectedTensors(const Manifest& manifest) {
  if (manifest.flow) return FlowTensors(manifest);
  const std::vector<SliceShape> slices = SliceShapes(manifest);
  const int64_t encoder = manifest.generator.encoder_hidden;
  const int64_t attention = manifest.generator.attention;
  const int64_t state = static_cast<int64_t>(slices.size()) * encoder;  // of one decoder direction
  const int64_t encoded = 2 * state;
  const int64_t outputs = int64_t{kCoordinates} * manifest.model.skeleton.joint_count();

  std::vector<TensorSpec> specs;
  for (const SliceShape& slice : slices) {
    const std::string at = absl::StrCat("encoder.", slice.name, ".");
    if (manifest.generator.slice_features > 0) {
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
  if (manifest.generator.base_pose) {
    if (manifest.generator.variant != GeneratorVariant::kUnlabelled) {
      specs.push_back({"base.weight", {outputs, manifest.model.class_count()}});
    }
    specs.push_back({"base.bias", {outputs}});
  }
  return specs;
}

}  // namespace duet::checkpoint
