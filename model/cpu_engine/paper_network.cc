#include "model/cpu_engine/paper_network.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "absl/strings/str_cat.h"
#include "model/cpu_engine/kernels/recurrent.h"

namespace duet::cpu_engine {
namespace {

using checkpoint::GeneratorVariant;
using checkpoint::PaperArchitecture;
using kernels::Precision;

constexpr const char* kDirections[] = {"forward", "backward"};

// Windows that are decoded together: the number that fills a tile of a product. The values of more
// windows would not stay in the second-level cache, and every step reads them again.
constexpr int kDecodedTogether = 4;

const PaperArchitecture& PaperOf(const checkpoint::Checkpoint& checkpoint) {
  return std::get<PaperArchitecture>(checkpoint.manifest.architecture);
}

// Columns of a row of the input that a slice reads.
std::vector<int> ColumnsOf(const checkpoint::Manifest& manifest, int slice) {
  const auto& paper = std::get<PaperArchitecture>(manifest.architecture);
  const auto& parts = manifest.parts;
  std::vector<int> columns;
  const auto add = [&](int first, int count) {
    for (int i = 0; i < count; ++i) columns.push_back(first + i);
  };
  if (slice < static_cast<int>(parts.size())) {
    for (const int joint : parts[static_cast<std::size_t>(slice)].joints) add(3 * joint, 3);
    return columns;
  }
  const motion::Skeleton& skeleton = manifest.model.skeleton;
  const int leader = 3 * skeleton.joint_count(), classes = manifest.model.class_count();
  if (paper.variant != GeneratorVariant::kReleased) add(0, leader);
  if (paper.variant != GeneratorVariant::kUnlabelled) add(leader, classes);
  if (paper.follower_start) {
    add(leader + classes, checkpoint::StartFeatureCount(skeleton));
  }
  return columns;
}

float* Copied(absl::Span<const motion::Vec3> points, float* out) {
  if (points.empty()) return out;
  return std::copy_n(&points.front().x, 3 * points.size(), out);
}

// Writes the root, the pose relative to the root, and two flags (root known, pose known).
void WriteStart(const std::optional<engine::FollowerStart>& start, int count, float* out) {
  std::fill_n(out, count, 0.0f);
  if (!start) return;
  out[count - 2] = 1;
  out[count - 1] = start->pose.empty() ? 0.0f : 1.0f;
  out = Copied({&start->root, 1}, out);
  for (const motion::Vec3& joint : start->pose) {
    const motion::Vec3 from_root = joint - start->root;
    out = Copied({&from_root, 1}, out);
  }
}

// Whether the calls of all these windows are cancelled.
bool AllCancelled(const WindowBatch& batch, absl::Span<const engine::NetworkInput> inputs) {
  return std::all_of(batch.input, batch.input + batch.count,
                     [&](int n) { return IsCancelled(inputs[static_cast<std::size_t>(n)]); });
}

// The frame that a direction reads in step `step` of a window of `length` frames.
int FrameAt(int direction, int length, int step) {
  return direction == 0 ? step : length - 1 - step;
}

}  // namespace

WindowBatch MakeWindowBatch(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch) {
  const int count = static_cast<int>(inputs.size());
  const auto frames = [&](int n) {
    return inputs[static_cast<std::size_t>(n)].leader.frame_count();
  };
  int* order = scratch->Take<int>(count);
  std::iota(order, order + count, 0);
  // Not stable_sort, which allocates.
  std::sort(order, order + count,
            [&](int a, int b) { return frames(a) != frames(b) ? frames(a) > frames(b) : a < b; });
  int* length = scratch->Take<int>(count);
  int* first_row = scratch->Take<int>(count);
  int rows = 0;
  for (int n = 0; n < count; ++n) {
    length[n] = frames(order[n]);
    first_row[n] = rows;
    rows += length[n];
  }
  return {count, rows, order, length, first_row};
}

PaperNetwork::PaperNetwork(const checkpoint::Checkpoint& checkpoint, Precision precision)
    : joints_(checkpoint.manifest.model.skeleton.joint_count()),
      classes_(checkpoint.manifest.model.class_count()),
      root_(checkpoint.manifest.model.skeleton.root),
      encoder_(PaperOf(checkpoint).encoder_hidden),
      attention_(PaperOf(checkpoint).attention),
      has_start_(PaperOf(checkpoint).follower_start),
      has_base_(PaperOf(checkpoint).base_pose),
      precision_(precision) {
  const checkpoint::Manifest& manifest = checkpoint.manifest;
  const Weights weights(checkpoint);
  inputs_ = 3 * joints_ + classes_ +
            (has_start_ ? checkpoint::StartFeatureCount(manifest.model.skeleton) : 0);
  const int slices = static_cast<int>(SliceShapes(manifest).size());
  for (int slice = 0; slice < slices; ++slice) {
    slices_.push_back(FindSlice(manifest, weights, slice));
  }
  state_ = slices * encoder_;
  for (int d = 0; d < 2; ++d) {
    const auto at = [&](const char* name) {
      return absl::StrCat("decoder.", kDirections[d], ".", name);
    };
    directions_[d] = {weights.FindLayer(at("attention_encoded"), "").Pack(precision),
                      weights.FindLayer(at("weight_ih"), at("bias")).Pack(precision),
                      Stacked(weights.FindLayer(at("weight_hh"), ""),
                              weights.FindLayer(at("attention_state"), ""))
                          .Pack(precision),
                      weights.Values(at("attention_score"))};
  }
  output_ = weights.FindLayer("output").Pack(precision);
  if (!has_base_) return;
  base_.bias = weights.Values("base.bias");
  if (weights.Has("base.weight")) base_ = weights.FindLayer("base");
}

PaperNetwork::Slice PaperNetwork::FindSlice(const checkpoint::Manifest& manifest,
                                            const Weights& weights, int index) const {
  const std::string at =
      absl::StrCat("encoder.", SliceShapes(manifest)[static_cast<std::size_t>(index)].name, ".");
  Slice slice;
  slice.columns = ColumnsOf(manifest, index);
  Layer input[2];
  for (int d = 0; d < 2; ++d) {
    const std::string prefix = absl::StrCat(at, kDirections[d], ".");
    input[d] = weights.FindLayer(prefix + "weight_ih", prefix + "bias");
    if (weights.Has(at + "fc.weight")) input[d] = Chained(weights.FindLayer(at + "fc"), input[d]);
    slice.recurrent[d] = weights.FindLayer(prefix + "weight_hh", "").Pack(precision_);
  }
  slice.input = Stacked(input[0], input[1]).Pack(precision_);
  return slice;
}

void PaperNetwork::Run(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch,
                       absl::Span<motion::Poses> followers) const {
  Work work;
  work.inputs = inputs;
  work.batch = MakeWindowBatch(inputs, scratch);
  const std::ptrdiff_t rows = work.batch.rows, windows = work.batch.count;
  work.input = ReadInput(work.batch, inputs, scratch);
  work.encoded = scratch->Take<float>(rows * 2 * state_);
  work.states = scratch->Take<float>(rows * 2 * state_);
  for (int d = 0; d < 2; ++d) {
    work.hidden[d] = scratch->Take<float>(windows * state_);
    work.cell[d] = scratch->Take<float>(windows * state_);
    std::fill_n(work.cell[d], windows * state_, 0.0f);
  }
  Encode(work, scratch);
  const DecoderWork decoder = PrepareDecoder(work.batch, scratch);
  for (int first = 0; first < work.batch.count; first += kDecodedTogether) {
    const WindowBatch some = work.batch.Some(first, kDecodedTogether);
    for (int d = 0; d < 2; ++d) Decode(work, some, d, std::ptrdiff_t{first} * state_, decoder);
  }
  if (engine::AllCancelled(inputs)) return;
  float* const answer = scratch->Take<float>(rows * 3 * joints_);
  output_.Multiply(work.batch.rows, work.states, answer);
  if (has_base_) AddBase(work, answer);
  for (int n = 0; n < work.batch.count; ++n) {
    motion::Poses& follower = followers[static_cast<std::size_t>(work.batch.input[n])];
    std::copy_n(answer + std::ptrdiff_t{work.batch.first_row[n]} * 3 * joints_,
                3 * follower.all().size(), &follower.all().front().x);
  }
}

float* PaperNetwork::ReadInput(const WindowBatch& batch,
                               absl::Span<const engine::NetworkInput> inputs,
                               Scratch::Use* scratch) const {
  float* const rows = scratch->Take<float>(std::ptrdiff_t{batch.rows} * inputs_);
  const int start = 3 * joints_ + classes_;
  for (int n = 0; n < batch.count; ++n) {
    const engine::NetworkInput& input = inputs[static_cast<std::size_t>(batch.input[n])];
    float* const first = rows + std::ptrdiff_t{batch.first_row[n]} * inputs_;
    if (has_start_) WriteStart(input.start, inputs_ - start, first + start);
    for (int t = 0; t < batch.length[n]; ++t) {
      float* const row = first + std::ptrdiff_t{t} * inputs_;
      float* const labels = Copied(input.leader[t], row);
      std::copy_n(input.labels.data() + std::ptrdiff_t{t} * classes_, classes_, labels);
      if (t > 0) std::copy(first + start, first + inputs_, row + start);
    }
  }
  return rows;
}

void PaperNetwork::Encode(const Work& work, Scratch::Use* scratch) const {
  const std::ptrdiff_t rows = work.batch.rows;
  float* const columns = scratch->Take<float>(rows * inputs_);
  float* const gates = scratch->Take<float>(rows * 8 * encoder_);
  for (int s = 0; s < static_cast<int>(slices_.size()); ++s) {
    if (engine::AllCancelled(work.inputs)) return;
    const Slice& slice = slices_[static_cast<std::size_t>(s)];
    float* to = columns;
    for (std::ptrdiff_t row = 0; row < rows; ++row) {
      for (const int column : slice.columns) *to++ = work.input[row * inputs_ + column];
    }
    slice.input.Multiply(work.batch.rows, columns, gates);
    for (int d = 0; d < 2; ++d) EncodeSlice(work, s, d, gates, scratch);
  }
}

// `gates`: the input's part of the gates, [R, 2 x 4 E].
void PaperNetwork::EncodeSlice(const Work& work, int slice, int direction, const float* gates,
                               Scratch::Use* scratch) const {
  const WindowBatch& batch = work.batch;
  const std::ptrdiff_t at = std::ptrdiff_t{slice} * encoder_;
  float* const recurrent = scratch->Take<float>(std::ptrdiff_t{batch.count} * 4 * encoder_);
  const float** inputs = scratch->Take<const float*>(batch.count);
  float** outputs = scratch->Take<float*>(batch.count);
  kernels::LstmStep cells{0,
                          encoder_,
                          nullptr,
                          4 * std::ptrdiff_t{encoder_},
                          inputs,
                          work.hidden[direction] + at,
                          work.cell[direction] + at,
                          state_,
                          outputs};
  cells.count = batch.count;
  for (int step = 0; step < batch.length[0]; ++step) {
    cells.count = batch.LongerThan(step, cells.count);
    if (step > 0) {
      slices_[static_cast<std::size_t>(slice)].recurrent[direction].Multiply(
          cells.count, cells.state, state_, recurrent, 4 * std::ptrdiff_t{encoder_});
      cells.gates = recurrent;
    }
    for (int n = 0; n < cells.count; ++n) {
      const std::ptrdiff_t row = batch.first_row[n] + FrameAt(direction, batch.length[n], step);
      inputs[n] = gates + (row * 2 + direction) * 4 * encoder_;
      outputs[n] = work.encoded + (row * 2 + direction) * state_ + at;
    }
    kernels::LstmCells(cells);
  }
}

PaperNetwork::DecoderWork PaperNetwork::PrepareDecoder(const WindowBatch& batch,
                                                       Scratch::Use* scratch) const {
  const std::ptrdiff_t windows = std::min(batch.count, kDecodedTogether);
  const std::ptrdiff_t rows = windows * batch.length[0], width = 4 * std::ptrdiff_t{state_};
  DecoderWork work{};
  work.encoded = scratch->Take<float>(rows * attention_);
  work.values = scratch->Take<float>(rows * width);
  work.gates = scratch->Take<float>(windows * (width + attention_));
  work.weights = scratch->Take<float>(batch.length[0]);
  work.outputs = scratch->Take<float*>(windows);
  return work;
}

// Attention, then the cells, frame by frame in the direction's order. `batch` is a part of
// work.batch. If all its windows are cancelled, the remaining states keep their old values.
void PaperNetwork::Decode(const Work& work, const WindowBatch& batch, int direction,
                          std::ptrdiff_t hidden, const DecoderWork& decoder) const {
  if (AllCancelled(batch, work.inputs)) return;
  const Direction& weights = directions_[direction];
  const int width = 4 * state_, both = width + attention_;
  const float* const encoded = work.encoded + std::ptrdiff_t{batch.first_row[0]} * 2 * state_;
  weights.encoded.Multiply(batch.rows, encoded, decoder.encoded);
  weights.values.Multiply(batch.rows, encoded, decoder.values);
  kernels::LstmStep cells{batch.count,
                          state_,
                          decoder.gates,
                          both,
                          nullptr,
                          work.hidden[direction] + hidden,
                          work.cell[direction] + hidden,
                          state_,
                          decoder.outputs};
  for (int step = 0; step < batch.length[0]; ++step) {
    if (AllCancelled(batch, work.inputs)) return;
    cells.count = batch.LongerThan(step, cells.count);
    weights.state.Multiply(cells.count, cells.state, decoder.gates);
    for (int n = 0; n < cells.count; ++n) {
      float* const gates = decoder.gates + std::ptrdiff_t{n} * both;
      LookAt(batch, n, direction, decoder, gates);
      const std::ptrdiff_t row = batch.first_row[n] + FrameAt(direction, batch.length[n], step);
      decoder.outputs[n] = work.states + (row * 2 + direction) * state_;
    }
    kernels::LstmCells(cells);
  }
}

// Adds the attended values of window n to its gates. The query follows the gates.
void PaperNetwork::LookAt(const WindowBatch& batch, int n, int direction,
                          const DecoderWork& decoder, float* gates) const {
  const std::ptrdiff_t row = batch.first_row[n] - batch.first_row[0];
  const int width = 4 * state_, frames = batch.length[n];
  kernels::WeighFrames({frames, attention_, decoder.encoded + row * attention_, gates + width,
                        directions_[direction].score.data(), decoder.weights});
  kernels::AddWeighted(frames, width, decoder.values + row * width, decoder.weights, gates);
}

// Adds the base pose: the root and the pose relative to it, each from the follower's start if that
// contains it, else from the mean pose of the label vector.
void PaperNetwork::AddBase(const Work& work, float* followers) const {
  const int width = 3 * joints_;
  for (std::ptrdiff_t row = 0; row < work.batch.rows; ++row) {
    const float* const labels = work.input + row * inputs_ + width;
    const float* const start = labels + classes_;
    const auto mean = [&](int column) {
      const float* const weights = base_.weight.data() + std::ptrdiff_t{column} * base_.inputs;
      float value = base_.bias[static_cast<std::size_t>(column)];
      for (int c = 0; c < base_.inputs; ++c) {
        value += weights[c] * labels[c];
      }
      return value;
    };
    const bool root_known = has_start_ && start[inputs_ - width - classes_ - 2] != 0;
    const bool pose_known = has_start_ && start[inputs_ - width - classes_ - 1] != 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float mean_root = mean(3 * root_ + axis);
      const float root = root_known ? start[axis] : mean_root;
      for (int j = 0; j < joints_; ++j) {
        const int column = 3 * j + axis;
        const float pose = pose_known ? start[3 + column] : mean(column) - mean_root;
        followers[row * width + column] += root + pose;
      }
    }
  }
}

}  // namespace duet::cpu_engine
