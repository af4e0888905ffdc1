#include "model/network/batch.h"

#include <algorithm>

namespace duet::network {
namespace {

// Root, pose relative to the root, and two flags: what is known.
void WriteStart(const engine::FollowerStart& start, float* out) {
  motion::Vec3* points = reinterpret_cast<motion::Vec3*>(out);
  *points++ = start.root;
  for (const motion::Vec3& joint : start.pose) *points++ = joint - start.root;
}

torch::Tensor Starts(const checkpoint::Manifest& manifest, const std::vector<BatchItem>& items) {
  const int64_t width = checkpoint::StartFeatureCount(manifest.model.skeleton);
  torch::Tensor starts = torch::zeros({static_cast<int64_t>(items.size()), width});
  for (size_t n = 0; n < items.size(); ++n) {
    if (!items[n].start) continue;
    float* row = starts.data_ptr<float>() + static_cast<int64_t>(n) * width;
    WriteStart(*items[n].start, row);
    row[width - 2] = 1;
    row[width - 1] = items[n].start->pose.empty() ? 0.0f : 1.0f;
  }
  return starts;
}

}  // namespace

BatchItem StandardItem(const motion::Standardisation& frame,
                       const engine::SynthesisWindow& window) {
  BatchItem item{frame.Apply(window.leader), window.labels, std::nullopt};
  if (!window.start) return item;
  item.start = engine::FollowerStart{frame.Apply(window.start->root), {}};
  for (const motion::Vec3& joint : window.start->pose)
    item.start->pose.push_back(frame.Apply(joint));
  return item;
}

torch::Tensor PadPositions(const std::vector<const std::vector<motion::Vec3>*>& clips, int joints,
                           int64_t frames) {
  torch::Tensor padded =
      torch::zeros({static_cast<int64_t>(clips.size()), frames, 3 * int64_t{joints}});
  for (size_t n = 0; n < clips.size(); ++n) {
    const float* values = &clips[n]->front().x;
    std::copy(values, values + 3 * clips[n]->size(),
              padded.data_ptr<float>() + static_cast<int64_t>(n) * padded.stride(0));
  }
  return padded;
}

std::vector<motion::Vec3> TakePositions(const torch::Tensor& batch, int64_t clip, int64_t frames) {
  const torch::Tensor rows = batch[clip].narrow(0, 0, frames).contiguous();
  std::vector<motion::Vec3> positions(static_cast<size_t>(rows.numel() / 3));
  std::copy_n(rows.data_ptr<float>(), rows.numel(), &positions.front().x);
  return positions;
}

GeneratorInput MakeInput(const checkpoint::Manifest& manifest,
                         const std::vector<BatchItem>& items) {
  const int joints = manifest.model.skeleton.joint_count();
  const int64_t classes = manifest.model.class_count();
  std::vector<const std::vector<motion::Vec3>*> leaders;
  std::vector<int64_t> lengths;
  for (const BatchItem& item : items) {
    leaders.push_back(&item.leader);
    lengths.push_back(static_cast<int64_t>(item.leader.size()) / joints);
  }
  const int64_t frames = *std::max_element(lengths.begin(), lengths.end());
  GeneratorInput input;
  input.leader = PadPositions(leaders, joints, frames);
  input.labels = torch::zeros({static_cast<int64_t>(items.size()), frames, classes});
  for (size_t n = 0; n < items.size(); ++n) {
    std::copy(items[n].labels.begin(), items[n].labels.end(),
              input.labels.data_ptr<float>() + static_cast<int64_t>(n) * frames * classes);
  }
  if (manifest.generator.follower_start) input.start = Starts(manifest, items);
  input.lengths = torch::tensor(lengths);
  return input;
}

}  // namespace duet::network
