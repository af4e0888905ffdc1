#include "model/network/discriminator.h"

#include <cmath>

#include "model/network/recurrent.h"

namespace duet::network {

DiscriminatorImpl::DiscriminatorImpl(const DiscriminatorOptions& options) : options_(options) {
  layers_.push_back(MakeLayer("layer1", options.input));
  layers_.push_back(MakeLayer("layer2", 2 * options.hidden));
  output_ = register_module(
      "output", torch::nn::Linear(options.window_frames * 2 * options.hidden, options.outputs));
}

DiscriminatorImpl::Layer DiscriminatorImpl::MakeLayer(const std::string& name, int64_t input) {
  const int64_t gates = 4 * options_.hidden;
  const double bound = 1 / std::sqrt(static_cast<double>(options_.hidden));
  const auto make = [&](const std::string& suffix, std::vector<int64_t> shape) {
    torch::Tensor value = torch::empty(shape).uniform_(-bound, bound);
    return register_parameter(name + "_" + suffix, value);
  };
  return {make("weight_ih", {2, gates, input}), make("weight_hh", {2, gates, options_.hidden}),
          make("bias", {2, gates})};
}

torch::Tensor DiscriminatorImpl::Run(const Layer& layer, const torch::Tensor& input,
                                     const torch::Tensor& lengths) const {
  const int64_t frames = input.size(0), batch = input.size(1);
  const torch::Tensor reversed = ReversedRows(lengths, frames);
  const torch::Tensor rows = input.reshape({frames * batch, -1});
  const torch::Tensor both = torch::stack({rows, rows.index_select(0, reversed)});
  const torch::Tensor gates =
      torch::baddbmm(layer.bias.unsqueeze(1), both, layer.weight_ih.transpose(1, 2))
          .reshape({2, frames, batch, -1})
          .transpose(0, 1);
  const torch::Tensor zero = torch::zeros({2, batch, options_.hidden}, input.options());
  const torch::Tensor hidden = LstmSequence(gates, layer.weight_hh, zero, zero).first;
  const auto directions = hidden.unbind(1);
  const torch::Tensor backward = directions[1]
                                     .reshape({frames * batch, -1})
                                     .index_select(0, reversed)
                                     .reshape({frames, batch, -1});
  return torch::cat({directions[0], backward}, 2) *
         FrameMask(lengths, frames).unsqueeze(2).to(input.scalar_type());
}

torch::Tensor DiscriminatorImpl::RunBoth(const torch::Tensor& motion,
                                         const torch::Tensor& lengths) const {
  torch::Tensor x = motion.transpose(0, 1);
  for (const Layer& layer : layers_) {
    x = torch::dropout(Run(layer, x, lengths), dropout_, is_training());
  }
  return x;
}

torch::Tensor DiscriminatorImpl::forward(const torch::Tensor& motion,
                                         const torch::Tensor& lengths) {
  const torch::Tensor hidden = RunBoth(motion, lengths).transpose(0, 1);  // [N, T, 2 H]
  const torch::Tensor padded =
      torch::constant_pad_nd(hidden, {0, 0, 0, options_.window_frames - hidden.size(1)});
  return output_(padded.flatten(1));
}

torch::Tensor DiscriminatorImpl::Features(const torch::Tensor& motion,
                                          const torch::Tensor& lengths) {
  return RunBoth(motion, lengths).sum(0) / lengths.unsqueeze(1).to(motion.scalar_type());
}

void DiscriminatorImpl::NormaliseKernels() {
  torch::NoGradGuard no_grad;
  for (Layer& layer : layers_) {
    layer.weight_ih.div_(layer.weight_ih.norm(2, {2}, true).clamp_min(1e-12));
  }
}

}  // namespace duet::network
