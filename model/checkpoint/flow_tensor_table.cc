#include "model/checkpoint/flow_tensor_table.h"

#include "absl/strings/str_cat.h"

namespace duet::checkpoint {
namespace {

constexpr int64_t kModulations = 4;  // shift and scale, before attention and before feed-forward
constexpr int64_t kStartStates = 2;  // no start told, start told

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

std::vector<TensorSpec> FlowTensors(const Manifest& manifest) {
  const FlowArchitecture& flow = *manifest.flow;
  const int64_t width = flow.width, classes = manifest.model.class_count();
  const int64_t pose = 3 * int64_t{manifest.model.skeleton.joint_count()};
  std::vector<TensorSpec> specs;
  AddLinear("frames", width, 2 * pose + kPositionFeatures + pose + 1, &specs);
  specs.push_back({"sample.weight", {width, pose}});
  AddLinear("start", width, StartFeatureCount(manifest.model.skeleton), &specs);
  specs.push_back({"label.weight", {width, classes}});
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
