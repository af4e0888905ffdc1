#include "model/network/flow_generator.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "model/network/batch.h"

namespace duet::network {
namespace {

constexpr double kFarBelow = -1e4;         // makes the weight of a frame 0 after the softmax
constexpr double kVelocityScale = 4;       // metres per frame are small numbers
constexpr double kPositionFrames = 20;     // one unit of a frame's distance from the window's ends
constexpr double kHighestFrequency = 200;  // of the sines of the time
constexpr int64_t kTimeFrequencies = 16;

bool IsMeasured(const std::string& name) { return name == "base.poses" || name == "noise.roots"; }

const checkpoint::FlowArchitecture& FlowOf(const checkpoint::Manifest& manifest) {
  return std::get<checkpoint::FlowArchitecture>(manifest.architecture);
}

// Tensors initialised with 0: blocks then start as the identity, and the answer as the base pose.
bool BeginsAtZero(const std::string& name) {
  return absl::EndsWith(name, ".bias") || absl::StrContains(name, ".modulation.") ||
         absl::EndsWith(name, ".distance") || absl::StartsWith(name, "output.") || IsMeasured(name);
}

torch::Tensor InitialValue(const std::string& name, const std::vector<int64_t>& shape) {
  if (name == "norm.weight") return torch::ones(shape);
  if (BeginsAtZero(name)) return torch::zeros(shape);
  const double bound = 1 / std::sqrt(static_cast<double>(shape.back()));
  return torch::empty(shape).uniform_(-bound, bound);
}

// [N, T, 4] position of each frame in its window.
torch::Tensor Positions(const torch::Tensor& lengths, int64_t frames) {
  const torch::Tensor length = lengths.to(torch::kFloat32).unsqueeze(1);
  const torch::Tensor frame =
      torch::arange(frames, length.options()).unsqueeze(0).expand({lengths.size(0), frames});
  return torch::stack({frame / kPositionFrames, frame / length, (length - frame) / kPositionFrames,
                       (length / kPositionFrames).expand_as(frame)},
                      2);
}

// [N, T, 3 J] metres per frame; 0 in the first.
torch::Tensor Velocity(const torch::Tensor& motion) {
  const torch::Tensor moved = motion.slice(1, 1) - motion.slice(1, 0, -1);
  return torch::cat({torch::zeros_like(motion.narrow(1, 0, 1)), moved}, 1);
}

torch::Tensor TimeFeatures(const torch::Tensor& times) {
  const torch::Tensor frequency = torch::exp(
      torch::linspace(0, std::log(kHighestFrequency), kTimeFrequencies, times.options()));
  const torch::Tensor angle = times.unsqueeze(1) * frequency.unsqueeze(0);
  return torch::cat({torch::sin(angle), torch::cos(angle)}, 1);
}

torch::Tensor Padding(const torch::Tensor& lengths, int64_t frames) {
  const torch::Tensor is_padding =
      torch::arange(frames, lengths.options()).unsqueeze(0) >= lengths.unsqueeze(1);
  return (is_padding.to(torch::kFloat32) * kFarBelow).view({-1, 1, 1, frames});
}

// Adaptive layer norm: scale and shift, [N, W] each, depend on the condition.
torch::Tensor Normalised(const torch::Tensor& frames, const torch::Tensor& scale,
                         const torch::Tensor& shift) {
  return torch::layer_norm(frames, {frames.size(2)}) * (1 + scale.unsqueeze(1)) +
         shift.unsqueeze(1);
}

}  // namespace

FlowContext Rows(const FlowContext& context, const torch::Tensor& rows) {
  return {context.frames.index_select(0, rows), context.condition.index_select(0, rows),
          context.padding.index_select(0, rows)};
}

FlowGeneratorImpl::FlowGeneratorImpl(const checkpoint::Manifest& manifest)
    : frame_labels_(FlowOf(manifest).frame_labels),
      hidden_frames_(FlowOf(manifest).hidden_frames),
      heads_(FlowOf(manifest).heads),
      reach_(FlowOf(manifest).reach) {
  for (const checkpoint::TensorSpec& spec : ExpectedTensors(manifest)) {
    Add(spec.name, InitialValue(spec.name, spec.shape), !IsMeasured(spec.name));
  }
  frames_ = FindLinear("frames");
  sample_ = FindLinear("sample");
  start_ = FindLinear("start");
  if (!frame_labels_) label_ = FindLinear("label");
  time_expand_ = FindLinear("time.expand");
  time_mix_ = FindLinear("time.mix");
  condition_ = FindLinear("condition");
  norm_ = FindLinear("norm");
  output_ = FindLinear("output");
  for (int i = 0; i < FlowOf(manifest).blocks; ++i) {
    blocks_.push_back(FindBlock(absl::StrCat("block", i)));
  }
  base_poses_ = Named("base.poses");
  noise_roots_ = Named("noise.roots");
}

FlowGeneratorImpl::Linear FlowGeneratorImpl::FindLinear(const std::string& name) const {
  return {Named(name + ".weight"), Named(name + ".bias")};
}

FlowGeneratorImpl::Block FlowGeneratorImpl::FindBlock(const std::string& name) const {
  return {FindLinear(name + ".modulation"), FindLinear(name + ".attention"),
          FindLinear(name + ".attended"),   FindLinear(name + ".expand"),
          FindLinear(name + ".contract"),   Named(name + ".distance")};
}

void FlowGeneratorImpl::SetMeasured(const torch::Tensor& base_poses,
                                    const torch::Tensor& noise_roots) {
  base_poses_.copy_(base_poses);
  noise_roots_.copy_(noise_roots);
}

torch::Tensor FlowGeneratorImpl::Dropped(const torch::Tensor& values) const {
  return torch::dropout(values, dropout_, is_training());
}

FlowContext FlowGeneratorImpl::Prepare(const FlowInput& input) const {
  const int64_t frames = input.leader.size(1);
  std::vector<torch::Tensor> features = {input.leader, kVelocityScale * Velocity(input.leader),
                                         Positions(input.lengths, frames), input.known,
                                         input.is_known};
  if (frame_labels_) features.push_back(input.labels);
  if (hidden_frames_) features.push_back(input.is_hidden);
  return {frames_(torch::cat(features, 2)), start_(input.start), Padding(input.lengths, frames)};
}

torch::Tensor FlowGeneratorImpl::forward(const FlowContext& context, const torch::Tensor& labels,
                                         const torch::Tensor& sample,
                                         const torch::Tensor& times) const {
  const torch::Tensor time = time_mix_(torch::silu(time_expand_(TimeFeatures(times))));
  const torch::Tensor told =
      (frame_labels_ ? context.condition : context.condition + label_(labels)) + time;
  const torch::Tensor condition = torch::silu(condition_(told));
  torch::Tensor frames = Dropped(context.frames + sample_(sample) + condition.unsqueeze(1));
  for (const Block& block : blocks_) frames = Apply(block, frames, condition, context.padding);
  return output_(torch::layer_norm(frames, {frames.size(2)}, norm_.weight, norm_.bias));
}

torch::Tensor FlowGeneratorImpl::Apply(const Block& block, const torch::Tensor& frames,
                                       const torch::Tensor& condition,
                                       const torch::Tensor& padding) const {
  const std::vector<torch::Tensor> by = block.modulation(condition).chunk(4, 1);
  const torch::Tensor attended =
      frames + Dropped(Attend(block, Normalised(frames, by[0], by[1]), padding));
  const torch::Tensor expanded = torch::gelu(block.expand(Normalised(attended, by[2], by[3])));
  return attended + Dropped(block.contract(expanded));
}

torch::Tensor FlowGeneratorImpl::Attend(const Block& block, const torch::Tensor& frames,
                                        const torch::Tensor& padding) const {
  const int64_t count = frames.size(0), length = frames.size(1), width = frames.size(2);
  const int64_t size = width / heads_;
  // [3, N heads, T, size]
  const torch::Tensor all = block.attention(frames)
                                .view({count, length, 3, heads_, size})
                                .permute({2, 0, 3, 1, 4})
                                .reshape({3, count * heads_, length, size});
  const torch::Tensor frame = torch::arange(length, frames.options().dtype(torch::kInt64));
  const torch::Tensor distance =
      (frame.unsqueeze(0) - frame.unsqueeze(1)).clamp(-reach_, reach_).add(reach_).flatten();
  const torch::Tensor bias =
      (block.distance.index_select(1, distance).view({1, heads_, length, length}) + padding)
          .reshape({count * heads_, length, length});
  const torch::Tensor scores = torch::baddbmm(bias, all[0], all[1].transpose(1, 2), 1,
                                              1 / std::sqrt(static_cast<double>(size)));
  const torch::Tensor values = torch::bmm(torch::softmax(scores, 2), all[2])
                                   .view({count, heads_, length, size})
                                   .transpose(1, 2)
                                   .reshape({count, length, width});
  return block.attended(values);
}

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
