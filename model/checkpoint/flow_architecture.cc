#include "model/checkpoint/flow_architecture.h"

#include <nlohmann/json.hpp>
#include <string>

#include "absl/strings/str_cat.h"
#include "model/checkpoint/architecture_json.h"
#include "model/checkpoint/manifest.h"

namespace duet::checkpoint {
namespace {

// Far above any use, and low enough that a small file cannot ask for a huge network or endless
// steps.
constexpr int kMaxUnits = 4096;
constexpr int kMaxBlocks = 64;
constexpr int kMaxSteps = 100;

constexpr char kFrameLabels[] = "frame_labels";
constexpr char kHiddenFrames[] = "hidden_frames";

constexpr int64_t kModulations = 4;  // shift and scale, before attention and before feed-forward
constexpr int64_t kStartStates = 2;  // without a start, with a start

FlowArchitecture::Noise ReadNoise(base::ObjectReader* reader) {
  FlowArchitecture::Noise noise;
  const std::string at = reader->PathOf("noise");
  const nlohmann::json& object = reader->Object("noise");
  if (!reader->ok()) return noise;
  base::ObjectReader fields(object, at);
  noise.frame_length = fields.Number("frame_length", 0.1, 1000);
  noise.constant_share = fields.Number("constant_share", 0, 1);
  noise.ramp_frames = static_cast<int>(fields.Int("ramp_frames", 1, kMaxUnits));
  noise.white = fields.Number("white", 0, 10);
  reader->Update(fields.Finish());
  return noise;
}

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

}  // namespace

void ReadFields(base::ObjectReader* reader, FlowArchitecture* out) {
  out->width = static_cast<int>(reader->Int("width", 1, kMaxUnits));
  out->blocks = static_cast<int>(reader->Int("blocks", 1, kMaxBlocks));
  out->heads = static_cast<int>(reader->Int("heads", 1, kMaxUnits));
  if (reader->ok() && out->width % out->heads != 0) {
    reader->Fail("heads", absl::StrCat("expected a divisor of the width ", out->width, ", got ",
                                       out->heads));
  }
  out->feed_forward = static_cast<int>(reader->Int("feed_forward", 1, kMaxUnits));
  out->reach = static_cast<int>(reader->Int("reach", 1, kMaxUnits));
  // Optional: checkpoints of earlier versions do not have them.
  out->frame_labels = reader->Has(kFrameLabels) && reader->Bool(kFrameLabels);
  out->hidden_frames = reader->Has(kHiddenFrames) && reader->Bool(kHiddenFrames);
  out->offset_scale = reader->Number("offset_scale", 1e-6, 1e3);
  out->noise = ReadNoise(reader);
  out->steps = static_cast<int>(reader->Int("steps", 1, kMaxSteps));
  out->guidance = reader->Number("guidance", 0, 10);
  if (reader->ok() && out->frame_labels && out->guidance != 1) {
    reader->Fail("guidance",
                 absl::StrCat("expected 1 with ", kFrameLabels, ", got ", out->guidance));
  }
  out->fade_frames = static_cast<int>(reader->Int("fade_frames", 0, kMaxUnits));
}

nlohmann::ordered_json ToJson(const FlowArchitecture& flow) {
  nlohmann::ordered_json json = {{kArchitectureKind, FlowArchitecture::kKind},
                                 {"width", flow.width},
                                 {"blocks", flow.blocks},
                                 {"heads", flow.heads},
                                 {"feed_forward", flow.feed_forward},
                                 {"reach", flow.reach},
                                 {"offset_scale", flow.offset_scale},
                                 {"noise",
                                  {{"frame_length", flow.noise.frame_length},
                                   {"constant_share", flow.noise.constant_share},
                                   {"ramp_frames", flow.noise.ramp_frames},
                                   {"white", flow.noise.white}}},
                                 {"steps", flow.steps},
                                 {"guidance", flow.guidance},
                                 {"fade_frames", flow.fade_frames}};
  if (flow.frame_labels) json[kFrameLabels] = true;
  if (flow.hidden_frames) json[kHiddenFrames] = true;
  return json;
}

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

}  // namespace duet::checkpoint
