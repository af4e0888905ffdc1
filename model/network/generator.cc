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

constexpr const char* kDirections[] = {"forward", "backward"};

GeneratorParameters Allocate(const checkpoint::Manifest& manifest) {
  const std::vector<checkpoint::SliceShape> slices = SliceShapes(manifest);
  const auto& paper = std::get<checkpoint::PaperArchitecture>(manifest.architecture);
  const int64_t encoder = paper.encoder_hidden, attention = paper.attention;
  const int64_t count = static_cast<int64_t>(slices.size()), state = count * encoder;
  const int64_t outputs = 3 * int64_t{manifest.model.skeleton.joint_count()};
  GeneratorParameters parameters;
  for (const checkpoint::SliceShape& shape : slices) {
    GeneratorParameters::Slice& slice = parameters.slices.emplace_back();
    if (paper.slice_features > 0) {
      slice.fc_weight = torch::empty({shape.features, shape.input});
      slice.fc_bias = torch::empty({shape.features});
    }
    slice.weight_ih = torch::empty({2, 4 * encoder, shape.features});
    slice.bias = torch::empty({2 * 4 * encoder});
  }
  parameters.encoder_weight_hh = torch::empty({2 * count, 4 * encoder, encoder});
  parameters.decoder = {
      torch::empty({2, attention, 2 * state}), torch::empty({2, attention, state}),
      torch::empty({2 * attention}),           torch::empty({2, 4 * state, 2 * state}),
      torch::empty({2, 4 * state, state}),     torch::empty({2 * 4 * state})};
  parameters.output_weight = torch::empty({outputs, 2 * state});
  parameters.output_bias = torch::empty({outputs});
  if (!paper.base_pose) return parameters;
  if (paper.variant != checkpoint::GeneratorVariant::kUnlabelled) {
    parameters.base_weight = torch::empty({outputs, manifest.model.class_count()});
  }
  parameters.base_bias = torch::empty({outputs});
  return parameters;
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

// One half of a flat pair of vectors.
torch::Tensor Half(const torch::Tensor& pair, int64_t direction) {
  return pair.chunk(2, 0)[static_cast<std::size_t>(direction)];
}

using Views = std::map<std::string, torch::Tensor>;

void AddSlice(const std::string& name, const GeneratorParameters::Slice& slice,
              const torch::Tensor& weight_hh, int64_t index, Views* views) {
  const std::string at = absl::StrCat("encoder.", name, ".");
  if (slice.fc_weight.defined()) {
    (*views)[at + "fc.weight"] = slice.fc_weight;
    (*views)[at + "fc.bias"] = slice.fc_bias;
  }
  for (const int64_t d : {0, 1}) {
    const std::string prefix = absl::StrCat(at, kDirections[d], ".");
    (*views)[prefix + "weight_ih"] = slice.weight_ih[d];
    (*views)[prefix + "weight_hh"] = weight_hh[d * (weight_hh.size(0) / 2) + index];
    (*views)[prefix + "bias"] = Half(slice.bias, d);
  }
}

void AddDecoder(const GeneratorParameters::Decoder& decoder, Views* views) {
  for (const int64_t d : {0, 1}) {
    const std::string prefix = absl::StrCat("decoder.", kDirections[d], ".");
    (*views)[prefix + "attention_encoded"] = decoder.attention_encoded[d];
    (*views)[prefix + "attention_state"] = decoder.attention_state[d];
    (*views)[prefix + "attention_score"] = Half(decoder.attention_score, d);
    (*views)[prefix + "weight_ih"] = decoder.weight_ih[d];
    (*views)[prefix + "weight_hh"] = decoder.weight_hh[d];
    (*views)[prefix + "bias"] = Half(decoder.bias, d);
  }
}

// All tensors by their names in ExpectedTensors: views into the parameters, without gradient.
Views ViewsByName(const GeneratorParameters& parameters,
                  const std::vector<checkpoint::SliceShape>& slices) {
  torch::NoGradGuard no_grad;
  Views views;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    AddSlice(slices[i].name, parameters.slices[i], parameters.encoder_weight_hh,
             static_cast<int64_t>(i), &views);
  }
  AddDecoder(parameters.decoder, &views);
  views["output.weight"] = parameters.output_weight;
  views["output.bias"] = parameters.output_bias;
  if (parameters.base_weight.defined()) views["base.weight"] = parameters.base_weight;
  if (parameters.base_bias.defined()) views["base.bias"] = parameters.base_bias;
  for (auto& view : views) view.second = view.second.detach();
  return views;
}

// Initialises randomly, with LibTorch's random number generator.
GeneratorParameters MakeParameters(const checkpoint::Manifest& manifest) {
  torch::NoGradGuard no_grad;
  GeneratorParameters parameters = Allocate(manifest);
  Views views = ViewsByName(parameters, SliceShapes(manifest));
  // In the order of ExpectedTensors, so that the network of a seed does not depend on the layout.
  for (const checkpoint::TensorSpec& spec : ExpectedTensors(manifest)) {
    views.at(spec.name).copy_(InitialValue(spec));
  }
  return parameters;
}

// The defined tensors with the names that a module registers them by. The module replaces each by
// the registered tensor.
std::vector<std::pair<std::string, torch::Tensor*>> Registered(GeneratorParameters* parameters) {
  std::vector<std::pair<std::string, torch::Tensor*>> named;
  const auto add = [&](const std::string& name, torch::Tensor* tensor) {
    if (tensor->defined()) named.emplace_back(name, tensor);
  };
  for (std::size_t i = 0; i < parameters->slices.size(); ++i) {
    GeneratorParameters::Slice& slice = parameters->slices[i];
    const std::string at = absl::StrCat("encoder/", i, "/");
    add(at + "fc_weight", &slice.fc_weight);
    add(at + "fc_bias", &slice.fc_bias);
    add(at + "weight_ih", &slice.weight_ih);
    add(at + "bias", &slice.bias);
  }
  GeneratorParameters::Decoder& decoder = parameters->decoder;
  add("encoder/weight_hh", &parameters->encoder_weight_hh);
  add("decoder/attention_encoded", &decoder.attention_encoded);
  add("decoder/attention_state", &decoder.attention_state);
  add("decoder/attention_score", &decoder.attention_score);
  add("decoder/weight_ih", &decoder.weight_ih);
  add("decoder/weight_hh", &decoder.weight_hh);
  add("decoder/bias", &decoder.bias);
  add("output/weight", &parameters->output_weight);
  add("output/bias", &parameters->output_bias);
  add("base/weight", &parameters->base_weight);
  add("base/bias", &parameters->base_bias);
  return named;
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

std::map<std::string, torch::Tensor> GeneratorImpl::tensors() const {
  return ViewsByName(parameters_, slice_shapes_);
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
