#include "model/checkpoint/architecture.h"

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>

#include "absl/strings/str_cat.h"
#include "model/checkpoint/checkpoint.h"
#include "model/checkpoint/json_fields.h"
#include "model/checkpoint/manifest.h"

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

constexpr Named<GeneratorVariant> kVariantNames[] = {{"paper", GeneratorVariant::kPaper},
                                                     {"released", GeneratorVariant::kReleased},
                                                     {"unlabelled", GeneratorVariant::kUnlabelled}};

void Declare(Fields* fields, PaperArchitecture* paper) {
  fields->Choice("variant", kVariantNames, &paper->variant);
  fields->Bool("follower_start", &paper->follower_start);
  fields->Int("slice_features", 0, kMaxUnits, &paper->slice_features);
  fields->Int("encoder_hidden", 1, kMaxUnits, &paper->encoder_hidden);
  fields->Int("attention", 1, kMaxUnits, &paper->attention);
  fields->Bool("base_pose", &paper->base_pose);
}

}  // namespace

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

namespace {

// Far above any use, and low enough that a small file cannot ask for a huge network or endless
// steps.
constexpr int kMaxBlocks = 64;
constexpr int kMaxSteps = 100;

constexpr int64_t kModulations = 4;  // shift and scale, before attention and before feed-forward
constexpr int64_t kStartStates = 2;  // without a start, with a start

void AddLinear(const std::string& name, int64_t outputs, int64_t inputs,
               std::vector<TensorSpec>* specs) {
  specs->push_back({name + ".weight", {outputs, inputs}});
  specs->push_back({name + ".bias", {outputs}});
}

void AddBlock(const std::string& name, const FlowArchitecture& flow,
              std::vector<TensorSpec>* specs) {
  const int64_t width = flow.width;
  AddLinear(name + ".modulation", kModulations * width, width, specs);
  AddLinear(name + ".attention", 3 * width, width, specs);
  AddLinear(name + ".attended", width, width, specs);
  specs->push_back({name + ".distance", {flow.heads, 2 * int64_t{flow.reach} + 1}});
  AddLinear(name + ".expand", flow.feed_forward, width, specs);
  AddLinear(name + ".contract", width, flow.feed_forward, specs);
}

void Declare(Fields* fields, FlowArchitecture* flow) {
  fields->Int("width", 1, kMaxUnits, &flow->width);
  fields->Int("blocks", 1, kMaxBlocks, &flow->blocks);
  fields->Int("heads", 1, kMaxUnits, &flow->heads);
  if (fields->ReadsWell() && flow->width % flow->heads != 0) {
    fields->Fail("heads", absl::StrCat("expected a divisor of the width ", flow->width, ", got ",
                                       flow->heads));
  }
  fields->Int("feed_forward", 1, kMaxUnits, &flow->feed_forward);
  fields->Int("reach", 1, kMaxUnits, &flow->reach);
  fields->Number("offset_scale", 1e-6, 1e3, &flow->offset_scale);
  fields->Section("noise", [&, &noise = flow->noise] {
    fields->Number("frame_length", 0.1, 1000, &noise.frame_length);
    fields->Share("constant_share", &noise.constant_share);
    fields->Int("ramp_frames", 1, kMaxUnits, &noise.ramp_frames);
    fields->Number("white", 0, 10, &noise.white);
  });
  fields->Int("steps", 1, kMaxSteps, &flow->steps);
  fields->Number("guidance", 0, 10, &flow->guidance);
  fields->Int("fade_frames", 0, kMaxUnits, &flow->fade_frames);
  // Checkpoints of earlier versions do not have them.
  fields->OptionalBool("frame_labels", &flow->frame_labels);
  fields->OptionalBool("hidden_frames", &flow->hidden_frames);
  if (fields->ReadsWell() && flow->frame_labels && flow->guidance != 1) {
    fields->Fail("guidance", absl::StrCat("expected 1 with frame_labels, got ", flow->guidance));
  }
}

}  // namespace

int64_t FrameFeatureCount(const Manifest& manifest, const FlowArchitecture& flow) {
  const int64_t pose = 3 * int64_t{manifest.model.skeleton.joint_count()};
  // Leader and velocity, positions, known offsets and their flag.
  return 2 * pose + kPositionFeatures + pose + 1 +
         (flow.frame_labels ? manifest.model.class_count() : 0) + (flow.hidden_frames ? 1 : 0);
}

std::vector<TensorSpec> Tensors(const Manifest& manifest, const FlowArchitecture& flow) {
  const int64_t width = flow.width, classes = manifest.model.class_count();
  const int64_t pose = 3 * int64_t{manifest.model.skeleton.joint_count()};
  std::vector<TensorSpec> specs;
  AddLinear("frames", width, FrameFeatureCount(manifest, flow), &specs);
  specs.push_back({"sample.weight", {width, pose}});
  AddLinear("start", width, StartFeatureCount(manifest.model.skeleton), &specs);
  if (!flow.frame_labels) specs.push_back({"label.weight", {width, classes}});
  AddLinear("time.expand", width, kTimeFeatures, &specs);
  AddLinear("time.mix", width, width, &specs);
  AddLinear("condition", width, width, &specs);
  for (int i = 0; i < flow.blocks; ++i) AddBlock(absl::StrCat("block", i), flow, &specs);
  specs.push_back({"norm.weight", {width}});
  specs.push_back({"norm.bias", {width}});
  AddLinear("output", pose, width, &specs);
  specs.push_back({"base.poses", {classes, pose}});
  specs.push_back({"noise.roots", {kStartStates, pose, pose}});
  return specs;
}

namespace {

template <typename T>
Architecture ReadAs(base::ObjectReader* reader) {
  T architecture;
  Fields fields(reader);
  Declare(&fields, &architecture);
  return architecture;
}

}  // namespace

Architecture ReadArchitecture(bool has_kind, base::ObjectReader* reader) {
  constexpr Named<Architecture (*)(base::ObjectReader*)> kReaders[] = {
      {PaperArchitecture::kKind, &ReadAs<PaperArchitecture>},
      {FlowArchitecture::kKind, &ReadAs<FlowArchitecture>}};
  if (!has_kind) return ReadAs<PaperArchitecture>(reader);
  const auto read = ReadNamed(reader, kArchitectureKind, kReaders);
  return reader->ok() ? read(reader) : Architecture();
}

nlohmann::ordered_json ToJson(const Architecture& architecture) {
  return std::visit(
      [](auto one) {
        nlohmann::ordered_json json;
        if (one.kSamples) json[kArchitectureKind] = one.kKind;  // the paper's is written last
        Fields fields(&json);
        Declare(&fields, &one);
        json[kArchitectureKind] = one.kKind;
        return json;
      },
      architecture);
}

void SetArchitecture(const Architecture& architecture, Manifest* manifest) {
  manifest->architecture = architecture;
  std::visit(
      [manifest](const auto& one) {
        manifest->model.samples = one.kSamples;
        manifest->model.accepts_follower_start = one.AcceptsFollowerStart();
        manifest->model.labels_guide = one.LabelsGuide();
      },
      architecture);
}

int StartFeatureCount(const motion::Skeleton& skeleton) {
  constexpr int kFlags = 2;  // root known, pose known
  return kCoordinates + kCoordinates * skeleton.joint_count() + kFlags;
}

std::vector<TensorSpec> ExpectedTensors(const Manifest& manifest) {
  return std::visit([&manifest](const auto& one) { return Tensors(manifest, one); },
                    manifest.architecture);
}

std::vector<TensorSpec> CriticTensors(const engine::ModelDescription& model) {
  constexpr int64_t kUnits = engine::kCriticUnits, kKernel = engine::kCriticKernel;
  return {
      {"critic.frames.weight", {kUnits, engine::CriticInputs(model.skeleton, model.class_count())}},
      {"critic.frames.bias", {kUnits}},
      {"critic.near.weight", {kUnits, kUnits, kKernel}},
      {"critic.near.bias", {kUnits}},
      {"critic.far.weight", {kUnits, kUnits, kKernel}},
      {"critic.far.bias", {kUnits}},
      {"critic.output.weight", {1, kUnits}},
      {"critic.output.bias", {1}}};
}

std::optional<engine::Critic> CriticOf(const Checkpoint& checkpoint) {
  if (checkpoint.critic.empty()) return std::nullopt;
  const auto values = [&](std::size_t i) { return checkpoint.critic[i].values; };
  const engine::ModelDescription& model = checkpoint.manifest.model;
  return engine::Critic(
      model.skeleton, model.frame_rate_hz,
      {values(0), values(1), values(2), values(3), values(4), values(5), values(6), values(7)});
}

}  // namespace duet::checkpoint
