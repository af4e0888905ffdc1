#include "model/network/generator_parameters.h"

#include <cmath>
#include <cstddef>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"

namespace duet::network {
namespace {

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

}  // namespace

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

std::map<std::string, torch::Tensor> ViewsByName(
    const GeneratorParameters& parameters, const std::vector<checkpoint::SliceShape>& slices) {
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

}  // namespace duet::network
