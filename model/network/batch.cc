#include "model/network/batch.h"

#include <algorithm>

namespace duet::network {
namespace {

// Writes the root, the pose relative to the root, and two flags (root known, pose known).
void WriteStart(const engine::FollowerStart& start, float* out) {
  motion::Vec3* points = reinterpret_cast<motion::Vec3*>(out);
  *points++ = start.root;
  for (const motion::Vec3& joint : start.pose) *points++ = joint - start.root;
}

torch::Tensor Starts(const checkpoint::Manifest& manifest,
                     absl::Span<const engine::NetworkInput> inputs) {
  const int64_t width = checkpoint::StartFeatureCount(manifest.model.skeleton);
  torch::Tensor starts = torch::zeros({static_cast<int64_t>(inputs.size()), width});
  float* row = starts.data_ptr<float>();
  for (const engine::NetworkInput& input : inputs) {
    if (input.start) {
      WriteStart(*input.start, row);
      row[width - 2] = 1;
      row[width - 1] = input.start->pose.empty() ? 0.0f : 1.0f;
    }
    row += width;
  }
  return starts;
}

torch::Tensor Labels(absl::Span<const engine::NetworkInput> inputs, int64_t frames,
                     int64_t classes) {
  torch::Tensor labels = torch::zeros({static_cast<int64_t>(inputs.size()), frames, classes});
  float* clip = labels.data_ptr<float>();
  for (const engine::NetworkInput& input : inputs) {
    std::copy(input.labels.begin(), input.labels.end(), clip);
    clip += labels.stride(0);
  }
  return labels;
}

}  // namespace

torch::Tensor PadPoses(const std::vector<const motion::Poses*>& clips, int64_t frames) {
  const int64_t joints = clips.front()->joint_count();
  torch::Tensor padded = torch::zeros({static_cast<int64_t>(clips.size()), frames, 3 * joints});
  float* out = padded.data_ptr<float>();
  for (const motion::Poses* clip : clips) {
    std::copy_n(&clip->all().front().x, 3 * clip->all().size(), out);
    out += padded.stride(0);
  }
  return padded;
}

motion::Poses TakePoses(const torch::Tensor& batch, int64_t clip, int frames) {
  const torch::Tensor rows = batch[clip].narrow(0, 0, frames).contiguous();
  motion::Poses poses(frames, static_cast<int>(rows.size(1) / 3));
  std::copy_n(rows.data_ptr<float>(), rows.numel(), &poses.all().front().x);
  return poses;
}

std::vector<motion::Poses> TakeAll(const torch::Tensor& batch,
                                   absl::Span<const engine::NetworkInput> inputs) {
  std::vector<motion::Poses> followers;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    followers.push_back(TakePoses(batch, static_cast<int64_t>(i), inputs[i].leader.frame_count()));
  }
  return followers;
}

GeneratorInput MakeInput(const checkpoint::Manifest& manifest,
                         absl::Span<const engine::NetworkInput> inputs) {
  std::vector<const motion::Poses*> leaders;
  std::vector<int64_t> lengths;
  for (const engine::NetworkInput& input : inputs) {
    leaders.push_back(&input.leader);
    lengths.push_back(input.leader.frame_count());
  }
  const int64_t frames = *std::max_element(lengths.begin(), lengths.end());
  GeneratorInput batch;
  batch.leader = PadPoses(leaders, frames);
  batch.labels = Labels(inputs, frames, manifest.model.class_count());
  const auto* const paper = std::get_if<checkpoint::PaperArchitecture>(&manifest.architecture);
  if (paper != nullptr && paper->follower_start) batch.start = Starts(manifest, inputs);
  batch.lengths = torch::tensor(lengths);
  return batch;
}

void AppendRows(const torch::Tensor& rows, std::vector<std::vector<float>>* out) {
  const torch::Tensor values = rows.contiguous();
  const float* row = values.data_ptr<float>();
  for (int64_t i = 0; i < values.size(0); ++i, row += values.size(1)) {
    out->emplace_back(row, row + values.size(1));
  }
}

}  // namespace duet::network
