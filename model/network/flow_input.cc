#include "model/network/flow_input.h"

#include <algorithm>
#include <vector>

#include "model/network/batch.h"

namespace duet::network {
namespace {

// The known frames of the follower in a window: none, or fewer than the leader's.
motion::Poses KnownFrames(const engine::NetworkInput& input) {
  if (!input.settled.empty()) return input.settled;
  if (!input.start || input.start->pose.empty()) return {};
  return {static_cast<int>(input.start->pose.size()), input.start->pose};
}

// Writes the root, the pose relative to the root, and two flags (root known, pose known).
void WriteStart(const motion::Poses& known, const engine::NetworkInput& input, int root,
                torch::Tensor features) {
  float* out = features.data_ptr<float>();
  const int64_t width = features.numel();
  if (known.empty() && !input.start) return;
  out[width - 2] = 1;
  motion::Vec3* points = reinterpret_cast<motion::Vec3*>(out);
  if (known.empty()) {
    points[0] = input.start->root;
    return;
  }
  out[width - 1] = 1;
  const absl::Span<const motion::Vec3> pose = known[known.frame_count() - 1];
  points[0] = pose[static_cast<std::size_t>(root)];
  for (std::size_t j = 0; j < pose.size(); ++j) points[1 + j] = pose[j] - points[0];
}

torch::Tensor Flat(absl::Span<const motion::Vec3> points) {
  return torch::from_blob(const_cast<float*>(&points.front().x),
                          {3 * static_cast<int64_t>(points.size())})
      .clone();
}

// mean + sum over the classes of weight (class mean - mean). Shapes: labels [frames, C].
torch::Tensor MeanPose(const torch::Tensor& base_poses, const torch::Tensor& labels) {
  const torch::Tensor mean = base_poses.mean(0);
  return mean + torch::matmul(labels.mean(0), base_poses - mean);
}

torch::Tensor MovedTo(const motion::Vec3& root, int root_joint, const torch::Tensor& pose) {
  const torch::Tensor place = torch::tensor({root.x, root.y, root.z});
  const torch::Tensor by = place - pose.narrow(0, 3 * int64_t{root_joint}, 3);
  return pose + by.repeat({pose.size(0) / 3});
}

}  // namespace

FlowInput FlowInput::To(const torch::Device& device) const {
  return {leader.to(device),   labels.to(device),      lengths.to(device),
          start.to(device),    base.to(device),        known.to(device),
          is_known.to(device), known_count.to(device), is_hidden.to(device)};
}

FlowInput MakeFlowInput(const checkpoint::Manifest& manifest, const torch::Tensor& base_poses,
                        absl::Span<const engine::NetworkInput> inputs) {
  const GeneratorInput clips = MakeInput(manifest, inputs);
  const int64_t count = clips.leader.size(0), frames = clips.leader.size(1),
                width = clips.leader.size(2);
  const int root = manifest.model.skeleton.root;
  const auto& flow = std::get<checkpoint::FlowArchitecture>(manifest.architecture);
  const double scale = flow.offset_scale;
  FlowInput batch{clips.leader,
                  clips.labels,
                  clips.lengths,
                  torch::zeros({count, checkpoint::StartFeatureCount(manifest.model.skeleton)}),
                  torch::zeros({count, width}),
                  torch::zeros({count, frames, width}),
                  torch::zeros({count, frames, 1}),
                  torch::zeros({count}, torch::kInt64),
                  torch::zeros({count, frames, 1})};
  for (int64_t n = 0; n < count; ++n) {
    const engine::NetworkInput& input = inputs[static_cast<std::size_t>(n)];
    const int64_t length = input.leader.frame_count();
    batch.is_hidden[n].slice(0, std::max<int64_t>(0, length - input.hidden_frames), length) = 1;
    const motion::Poses known = KnownFrames(input);
    WriteStart(known, input, root, batch.start[n]);
    if (known.empty()) {
      torch::Tensor base =
          flow.frame_labels
              ? base_poses.mean(0)
              : MeanPose(base_poses, clips.labels[n].narrow(0, 0, input.leader.frame_count()));
      if (input.start) base = MovedTo(input.start->root, root, base);
      batch.base[n] = base;
      continue;
    }
    const int64_t told = std::min<int64_t>(known.frame_count(), input.leader.frame_count());
    batch.base[n] = Flat(known[known.frame_count() - 1]);
    batch.known[n].narrow(0, 0, told) =
        (Flat(known.frames(0, static_cast<int>(told))).view({told, width}) - batch.base[n]) / scale;
    batch.is_known[n].narrow(0, 0, told) = 1;
    batch.known_count[n] = told;
  }
  return batch;
}

}  // namespace duet::network
