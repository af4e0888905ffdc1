#include "model/checkpoint/flow_json.h"

#include "absl/strings/str_cat.h"

namespace duet::checkpoint {
namespace {

using nlohmann::ordered_json;

// Far above any use, far below what would let a small file ask for a huge network or endless steps.
constexpr int kMaxUnits = 4096;
constexpr int kMaxBlocks = 64;
constexpr int kMaxSteps = 100;

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

}  // namespace

FlowArchitecture ReadFlowArchitecture(base::ObjectReader* reader) {
  FlowArchitecture flow;
  flow.width = static_cast<int>(reader->Int("width", 1, kMaxUnits));
  flow.blocks = static_cast<int>(reader->Int("blocks", 1, kMaxBlocks));
  flow.heads = static_cast<int>(reader->Int("heads", 1, kMaxUnits));
  if (reader->ok() && flow.width % flow.heads != 0) {
    reader->Fail("heads", absl::StrCat(flow.heads, ", wanted a divisor of the width ", flow.width));
  }
  flow.feed_forward = static_cast<int>(reader->Int("feed_forward", 1, kMaxUnits));
  flow.reach = static_cast<int>(reader->Int("reach", 1, kMaxUnits));
  flow.offset_scale = reader->Number("offset_scale", 1e-6, 1e3);
  flow.noise = ReadNoise(reader);
  flow.steps = static_cast<int>(reader->Int("steps", 1, kMaxSteps));
  flow.guidance = reader->Number("guidance", 0, 10);
  flow.fade_frames = static_cast<int>(reader->Int("fade_frames", 0, kMaxUnits));
  return flow;
}

ordered_json FlowArchitectureToJson(const FlowArchitecture& flow) {
  return {{kGeneratorKind, kFlowKind},
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
}

}  // namespace duet::checkpoint
