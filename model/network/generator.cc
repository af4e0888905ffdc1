#include "model/network/generator.h"

#include <cmath>
#include <cstddef>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "model/network/recurrent.h"

namespace duet::network {
namespace {

const checkpoint::PaperArchitecture& PaperOf(const checkpoint::Manifest& manifest) {
  return std::get<checkpoint::PaperArchitecture>(manifest.architecture);
}

torch::Tensor PartColumns(const motion::BodyPart& part) {
  std::vector<int64_t> columns;
  for (int joint : part.joints) {
    for (int64_t axis = 0; axis < 3; ++axis) columns.push_back(3 * int64_t{joint} + axis);
  }
  return torch::tensor(columns);
}

// The start of the names of a slice's LSTM in one direction.
std::string EncoderPrefix(const checkpoint::SliceShape& slice, const char* direction) {
  return absl::StrCat("encoder.", slice.name, ".", direction, ".");
}

// Uniform in +-1/sqrt(fan in), like LibTorch's own layers. The bias of an LSTM's forget gate is 1
// (open), so that early gradients reach across a clip.
torch::Tensor InitialValue(const checkpoint::TensorSpec& spec) {
  torch::Tensor value = torch::empty(spec.shape);
  const int64_t fan_in = spec.shape.back();
  if (!absl::EndsWith(spec.name, "bias")) {
    return value.uniform_(-1, 1).div_(std::sqrt(static_cast<double>(fan_in)));
  }
  value.zero_();
  const bool recurrent = absl::EndsWith(spec.name, "ward.bias");
  if (recurrent) value.slice(0, fan_in / 4, fan_in / 2).fill_(1);
  return value;
}

}  // namespace

GeneratorImpl::GeneratorImpl(const checkpoint::Manifest& manifest)
    : slice_shapes_(SliceShapes(manifest)),
      whole_body_reads_leader_(PaperOf(manifest).variant !=
                               checkpoint::GeneratorVariant::kReleased),
      reads_labels_(PaperOf(manifest).variant != checkpoint::GeneratorVariant::kUnlabelled),
      has_start_(PaperOf(manifest).follower_start),
      has_base_(PaperOf(manifest).base_pose),
      root_column_(3 * int64_t{manifest.model.skeleton.root}),
      encoder_hidden_(PaperOf(manifest).encoder_hidden) {
  for (const motion::BodyPart& part : manifest.parts) {
    columns_.push_back(PartColumns(part));
  }
  for (const checkpoint::TensorSpec& spec : ExpectedTensors(manifest)) {
    Add(spec.name, InitialValue(spec));
  }
}

torch::Tensor GeneratorImpl::BothDirections(const std::string& name) const {
  return torch::stack({Named("decoder.forward." + name), Named("decoder.backward." + name)});
}

torch::Tensor GeneratorImpl::SliceInput(const GeneratorInput& input, size_t slice) const {
  const torch::Tensor leader = input.leader.transpose(0, 1);  // [T, N, 3 J]
  if (slice < columns_.size()) return leader.index_select(2, columns_[slice]);
  std::vector<torch::Tensor> whole;
  if (whole_body_reads_leader_) whole.push_back(leader);
  if (reads_labels_) whole.push_back(input.labels.transpose(0, 1));
  if (has_start_) whole.push_back(input.start.unsqueeze(0).expand({leader.size(0), -1, -1}));
  return torch::cat(whole, 2);
}

torch::Tensor GeneratorImpl::Features(const GeneratorInput& input, size_t slice) const {
  const std::string fc = absl::StrCat("encoder.", slice_shapes_[slice].name, ".fc.");
  torch::Tensor features = SliceInput(input, slice);
  if (const torch::Tensor weight = Named(fc + "weight"); weight.defined()) {
    features = torch::nn::functional::linear(features, weight, Named(fc + "bias"));
  }
  return torch::dropout(features, slice_dropout_, is_training());
}

// The input's part of a slice's LSTM gates in both directions, the backward one reversed:
// [T, 2, N, 4 E].
torch::Tensor GeneratorImpl::SliceGates(const GeneratorInput& input, size_t slice,
                                        const torch::Tensor& reversed) const {
  const torch::Tensor features = Features(input, slice);
  const int64_t frames = features.size(0), batch = features.size(1);
  const torch::Tensor rows = features.reshape({frames * batch, -1});
  const auto gates = [&](const char* direction, const torch::Tensor& in) {
    const std::string at = EncoderPrefix(slice_shapes_[slice], direction);
    return torch::addmm(Named(at + "bias"), in, Named(at + "weight_ih").t())
        .reshape({frames, batch, 4 * encoder_hidden_});
  };
  return torch::stack({gates("forward", rows), gates("backward", rows.index_select(0, reversed))},
                      1);
}

GeneratorImpl::Encoded GeneratorImpl::EncodeAll(const GeneratorInput& input,
                                                const torch::Tensor& reversed) const {
  const int64_t frames = input.leader.size(1), batch = input.leader.size(0);
  const int64_t slices = static_cast<int64_t>(slice_shapes_.size()),
                units = slices * encoder_hidden_;
  std::vector<torch::Tensor> gates;
  for (size_t slice = 0; slice < slice_shapes_.size(); ++slice) {
    gates.push_back(SliceGates(input, slice, reversed));
  }
  // Groups: every slice forward, then every slice backward.
  std::vector<torch::Tensor> recurrent;
  for (const char* direction : {"forward", "backward"}) {
    for (const checkpoint::SliceShape& slice : slice_shapes_) {
      recurrent.push_back(Named(EncoderPrefix(slice, direction) + "weight_hh"));
    }
  }
  const torch::Tensor zero = torch::zeros({2 * slices, batch, encoder_hidden_}, gates[0].options());
  auto [hidden, cell] =
      LstmSequence(torch::stack(gates, 2).reshape({frames, 2 * slices, batch, -1}),
                   torch::stack(recurrent), zero, zero);
  const auto rows = [&](const torch::Tensor& states) {  // [T, G, N, E] -> [T N, G E]
    return states.transpose(1, 2).reshape({frames * batch, 2 * units});
  };
  const auto final_states = [&](const torch::Tensor& states) {  // -> [2, N, S E]
    return rows(states)
        .index_select(0, LastRows(input.lengths))
        .reshape({batch, 2, units})
        .transpose(0, 1);
  };
  const auto directions = rows(hidden).chunk(2, 1);
  const torch::Tensor both =
      torch::cat({directions[0], directions[1].index_select(0, reversed)}, 1);
  return {both.reshape({frames, batch, 2 * units}), final_states(hidden), final_states(cell)};
}

torch::Tensor GeneratorImpl::Decode(const Encoded& encoded, const GeneratorInput& input,
                                    const torch::Tensor& reversed) const {
  const int64_t frames = encoded.frames.size(0), batch = encoded.frames.size(1);
  const torch::Tensor by_clip = torch::dropout(encoded.frames, encoded_dropout_, is_training())
                                    .transpose(0, 1)
                                    .reshape({batch * frames, -1});
  // [2, N T, X] = h_j times each direction's matrix
  const auto project = [&](const char* weights) {
    return torch::matmul(by_clip, BothDirections(weights).transpose(1, 2));
  };
  DecoderInputs decoder;
  decoder.encoded = project("attention_encoded").reshape({2, batch, frames, -1});
  decoder.values =
      (project("weight_ih") + BothDirections("bias").unsqueeze(1)).reshape({2, batch, frames, -1});
  decoder.weight_hh = BothDirections("weight_hh");
  decoder.state = BothDirections("attention_state");
  decoder.score = BothDirections("attention_score");
  decoder.hidden = encoded.hidden;
  decoder.cell = encoded.cell;
  decoder.lengths = input.lengths;
  const auto directions = AttentiveDecoder(decoder).unbind(1);  // two of [T, N, H]
  const torch::Tensor backward =
      directions[1].reshape({frames * batch, -1}).index_select(0, reversed);
  const torch::Tensor states =
      torch::cat({directions[0].reshape({frames * batch, -1}), backward}, 1);
  return torch::addmm(Named("output.bias"), torch::dropout(states, encoded_dropout_, is_training()),
                      Named("output.weight").t())
      .reshape({frames, batch, -1})
      .transpose(0, 1);
}

// The pose that the output layer adds to, [N, T, 3 J]: root and pose relative to it, each from the
// follower's start if that contains it, else from the label vector's mean pose.
torch::Tensor GeneratorImpl::Base(const GeneratorInput& input) const {
  const torch::Tensor bias = Named("base.bias");
  const torch::Tensor mean =
      reads_labels_ ? torch::nn::functional::linear(input.labels, Named("base.weight"), bias)
                    : bias.expand({input.labels.size(0), input.labels.size(1), bias.size(0)});
  if (!has_start_) return mean;
  const int64_t joints = mean.size(2) / 3, pose_flag = input.start.size(1) - 1;
  const torch::Tensor start = input.start.unsqueeze(1);  // [N, 1, root, pose, flags]
  const torch::Tensor root_known = start.narrow(2, pose_flag - 1, 1);
  const torch::Tensor pose_known = start.narrow(2, pose_flag, 1);
  const torch::Tensor mean_root = mean.narrow(2, root_column_, 3);
  const torch::Tensor mean_pose = mean - mean_root.repeat({1, 1, joints});
  const torch::Tensor root = mean_root + root_known * (start.narrow(2, 0, 3) - mean_root);
  const torch::Tensor pose = mean_pose + pose_known * (start.narrow(2, 3, 3 * joints) - mean_pose);
  return root.repeat({1, 1, joints}) + pose;
}

void GeneratorImpl::SetBasePoses(const torch::Tensor& means) {
  torch::NoGradGuard no_grad;
  const torch::Tensor overall = means.mean(0);
  Named("base.bias").copy_(overall);
  if (reads_labels_) Named("base.weight").copy_((means - overall).t());
}

torch::Tensor GeneratorImpl::Encode(const GeneratorInput& input) {
  return EncodeAll(input, ReversedRows(input.lengths, input.leader.size(1))).frames;
}

torch::Tensor GeneratorImpl::forward(const GeneratorInput& input) {
  const torch::Tensor reversed = ReversedRows(input.lengths, input.leader.size(1));
  const torch::Tensor out = Decode(EncodeAll(input, reversed), input, reversed);
  return has_base_ ? out + Base(input) : out;
}

}  // namespace duet::network
