#include "model/network/generator.h"

#include "model/network/attentive_decoder.h"
#include "model/network/lstm.h"
#include "model/network/sequence.h"

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

}  // namespace

GeneratorImpl::GeneratorImpl(const checkpoint::Manifest& manifest)
    : slice_shapes_(SliceShapes(manifest)),
      parameters_(MakeParameters(manifest)),
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
  for (const auto& [name, tensor] : Registered(&parameters_)) {
    *tensor = register_parameter(name, *tensor);
  }
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
  const GeneratorParameters::Slice& parameters = parameters_.slices[slice];
  torch::Tensor features = SliceInput(input, slice);
  if (parameters.fc_weight.defined()) {
    features = torch::nn::functional::linear(features, parameters.fc_weight, parameters.fc_bias);
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
  const auto bias = parameters_.slices[slice].bias.chunk(2, 0);
  const auto weight = parameters_.slices[slice].weight_ih.unbind(0);
  const auto gates = [&](size_t direction, const torch::Tensor& in) {
    return torch::addmm(bias[direction], in, weight[direction].t())
        .reshape({frames, batch, 4 * encoder_hidden_});
  };
  return torch::stack({gates(0, rows), gates(1, rows.index_select(0, reversed))}, 1);
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
  const torch::Tensor zero = torch::zeros({2 * slices, batch, encoder_hidden_}, gates[0].options());
  // Groups: every slice forward, then every slice backward.
  auto [hidden, cell] =
      LstmSequence(torch::stack(gates, 2).reshape({frames, 2 * slices, batch, -1}),
                   parameters_.encoder_weight_hh, zero, zero);
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
  const auto project = [&](const torch::Tensor& weights) {
    return torch::matmul(by_clip, weights.transpose(1, 2));
  };
  const GeneratorParameters::Decoder& parameters = parameters_.decoder;
  DecoderInputs decoder;
  decoder.encoded = project(parameters.attention_encoded).reshape({2, batch, frames, -1});
  decoder.values = (project(parameters.weight_ih) + parameters.bias.view({2, 1, -1}))
                       .reshape({2, batch, frames, -1});
  decoder.weight_hh = parameters.weight_hh;
  decoder.state = parameters.attention_state;
  decoder.score = parameters.attention_score.view({2, -1});
  decoder.hidden = encoded.hidden;
  decoder.cell = encoded.cell;
  decoder.lengths = input.lengths;
  const auto directions = AttentiveDecoder(decoder).unbind(1);  // two of [T, N, H]
  const torch::Tensor backward =
      directions[1].reshape({frames * batch, -1}).index_select(0, reversed);
  const torch::Tensor states =
      torch::cat({directions[0].reshape({frames * batch, -1}), backward}, 1);
  return torch::addmm(parameters_.output_bias,
                      torch::dropout(states, encoded_dropout_, is_training()),
                      parameters_.output_weight.t())
      .reshape({frames, batch, -1})
      .transpose(0, 1);
}

// The pose that the output layer adds to, [N, T, 3 J]: root and pose relative to it, each from the
// follower's start if that contains it, else from the label vector's mean pose.
torch::Tensor GeneratorImpl::Base(const GeneratorInput& input) const {
  const torch::Tensor& bias = parameters_.base_bias;
  const torch::Tensor mean =
      reads_labels_ ? torch::nn::functional::linear(input.labels, parameters_.base_weight, bias)
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
  parameters_.base_bias.copy_(overall);
  if (reads_labels_) parameters_.base_weight.copy_((means - overall).t());
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
