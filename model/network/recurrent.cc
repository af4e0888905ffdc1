#include "model/network/recurrent.h"

#include <cstddef>
#include <vector>

// Both functions have gradients of their own: automatic differentiation would add up the gradients
// of weights and frames step by step, where one product over all steps gives the same sums.
namespace duet::network {
namespace {

using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

// [T, G, N, X] -> [G, T N, X]
at::Tensor ByGroup(const at::Tensor& x) {
  return x.transpose(0, 1).reshape({x.size(1), x.size(0) * x.size(2), x.size(3)});
}

// The states before each step, of the initial state and those after each step.
at::Tensor Before(const at::Tensor& initial, const at::Tensor& states) {
  return at::cat({initial.unsqueeze(0), states.narrow(0, 0, states.size(0) - 1)}, 0);
}

// One step of LSTM cells. Shapes: gates [G, N, 4 H] in the order i, f, g, o (pre-activations in,
// activations out); cell_before, cell, hidden [G, N, H], of which the last two are written.
void Step(const at::Tensor& gates, const at::Tensor& cell_before, at::Tensor cell,
          at::Tensor hidden) {
  const std::vector<at::Tensor> gate = gates.chunk(4, -1);
  for (const at::Tensor& sigmoid : {gate[0], gate[1], gate[3]}) sigmoid.sigmoid_();
  gate[2].tanh_();
  at::mul_out(cell, gate[1], cell_before).addcmul_(gate[0], gate[2]);
  at::tanh_out(hidden, cell).mul_(gate[3]);
}

// Its gradient: returns that of the pre-activations. `d_cell` holds dL/dcell in and dL/dcell_before
// out.
at::Tensor StepGradient(const at::Tensor& gates, const at::Tensor& cell_before,
                        const at::Tensor& cell, const at::Tensor& d_hidden, at::Tensor* d_cell) {
  const std::vector<at::Tensor> gate = gates.chunk(4, -1);
  const at::Tensor &i = gate[0], &f = gate[1], &g = gate[2], &o = gate[3];
  const at::Tensor tanh = cell.tanh();
  const at::Tensor d = *d_cell + at::tanh_backward(d_hidden * o, tanh);
  *d_cell = d * f;
  return at::cat({at::sigmoid_backward(d * g, i), at::sigmoid_backward(d * cell_before, f),
                  at::tanh_backward(d * i, g), at::sigmoid_backward(d_hidden * tanh, o)},
                 -1);
}

class LstmFunction : public torch::autograd::Function<LstmFunction> {
 public:
  static variable_list forward(AutogradContext* context, const at::Tensor& input_gates,
                               const at::Tensor& weight_hh, const at::Tensor& hidden0,
                               const at::Tensor& cell0) {
    const int64_t steps = input_gates.size(0);
    const at::Tensor gates = input_gates.clone(at::MemoryFormat::Contiguous);
    const at::Tensor hidden =
        hidden0.new_empty({steps, hidden0.size(0), hidden0.size(1), hidden0.size(2)});
    const at::Tensor cell = at::empty_like(hidden);
    for (int64_t t = 0; t < steps; ++t) {
      gates[t].baddbmm_(t == 0 ? hidden0 : hidden[t - 1], weight_hh.transpose(1, 2));
      Step(gates[t], t == 0 ? cell0 : cell[t - 1], cell[t], hidden[t]);
    }
    context->save_for_backward({gates, weight_hh, hidden0, cell0, hidden, cell});
    return {hidden, cell};
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const variable_list saved = context->get_saved_variables();
    const at::Tensor &gates = saved[0], &weight_hh = saved[1], &hidden0 = saved[2],
                     &hidden = saved[4], &cell = saved[5];
    for (at::Tensor& gradient : gradients) {
      if (!gradient.defined()) gradient = at::zeros_like(hidden);
    }
    const at::Tensor cell_before = Before(saved[3], cell), d_gates = at::empty_like(gates);
    at::Tensor d_hidden = at::zeros_like(hidden0), d_cell = at::zeros_like(hidden0);
    for (int64_t t = gates.size(0) - 1; t >= 0; --t) {
      d_cell = d_cell + gradients[1][t];
      d_gates[t].copy_(
          StepGradient(gates[t], cell_before[t], cell[t], d_hidden + gradients[0][t], &d_cell));
      d_hidden = at::bmm(d_gates[t], weight_hh);
    }
    const at::Tensor d_weight =
        at::bmm(ByGroup(d_gates).transpose(1, 2), ByGroup(Before(hidden0, hidden)));
    return {d_gates, d_weight, d_hidden, d_cell};
  }
};

class DecoderFunction : public torch::autograd::Function<DecoderFunction> {
 public:
  static at::Tensor forward(AutogradContext* context, const at::Tensor& encoded,
                            const at::Tensor& values, const at::Tensor& weight_hh,
                            const at::Tensor& state, const at::Tensor& score,
                            const at::Tensor& hidden0, const at::Tensor& cell0,
                            const at::Tensor& lengths, bool keeps_tanh) {
    const int64_t groups = values.size(0), batch = values.size(1), frames = values.size(2);
    const at::Tensor padding = ~FrameMask(lengths, frames).t().unsqueeze(0);  // [1, N, T]
    const at::Tensor gates = at::empty({frames, groups, batch, values.size(3)}, values.options());
    const at::Tensor weights = at::empty({frames, groups, batch, frames}, values.options());
    const at::Tensor hidden = at::empty({frames, groups, batch, hidden0.size(2)}, values.options());
    const at::Tensor cell = at::empty_like(hidden);
    variable_list saved = {encoded, values,  weight_hh, state,  score, hidden0,
                           cell0,   weights, gates,     hidden, cell};
    for (int64_t t = 0; t < frames; ++t) {
      const at::Tensor before = t == 0 ? hidden0 : hidden[t - 1];
      const at::Tensor query = at::bmm(before, state.transpose(1, 2)).unsqueeze(2);
      const at::Tensor tanh = (encoded + query).tanh_();  // [G, N, T, A]
      const at::Tensor energy = at::matmul(tanh, score.reshape({groups, 1, -1, 1})).squeeze(3);
      weights[t].copy_(energy.masked_fill_(padding, kFarBelow).softmax(2));
      gates[t].copy_(at::matmul(weights[t].unsqueeze(2), values).squeeze(2));
      gates[t].baddbmm_(before, weight_hh.transpose(1, 2));
      Step(gates[t], t == 0 ? cell0 : cell[t - 1], cell[t], hidden[t]);
      if (keeps_tanh) saved.push_back(tanh);
    }
    if (keeps_tanh) context->save_for_backward(saved);
    return hidden;
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const variable_list saved = context->get_saved_variables();
    const at::Tensor &encoded = saved[0], &values = saved[1], &weight_hh = saved[2],
                     &state = saved[3], &hidden0 = saved[5], &weights = saved[7], &gates = saved[8],
                     &hidden = saved[9], &cell = saved[10];
    const int64_t groups = values.size(0), rows = groups * values.size(1), frames = values.size(2);
    const at::Tensor score = saved[4].reshape({groups, 1, 1, -1});
    const at::Tensor cell_before = Before(saved[6], cell), d_gates = at::empty_like(gates);
    const at::Tensor d_encoded = at::zeros_like(encoded), d_score = at::zeros_like(saved[4]);
    const at::Tensor d_query =
        at::empty({frames, groups, values.size(1), state.size(1)}, values.options());
    at::Tensor d_hidden = at::zeros_like(hidden0), d_cell = at::zeros_like(hidden0);
    for (int64_t t = frames - 1; t >= 0; --t) {
      const at::Tensor& tanh = saved[kFirstTanh + static_cast<std::size_t>(t)];
      d_gates[t].copy_(
          StepGradient(gates[t], cell_before[t], cell[t], d_hidden + gradients[0][t], &d_cell));
      const at::Tensor d_weights = at::matmul(values, d_gates[t].unsqueeze(3)).squeeze(3);
      const at::Tensor mean = (weights[t] * d_weights).sum(2, /*keepdim=*/true);
      const at::Tensor d_energy = weights[t] * (d_weights - mean);  // [G, N, T]
      const at::Tensor through = at::tanh_backward(d_energy.unsqueeze(3) * score, tanh);
      d_encoded.add_(through);
      d_query[t].copy_(through.sum(2));
      d_score.add_(
          at::bmm(d_energy.reshape({groups, 1, -1}), tanh.reshape({groups, -1, tanh.size(3)}))
              .squeeze(1));
      d_hidden = at::bmm(d_gates[t], weight_hh) + at::bmm(d_query[t], state);
    }
    const at::Tensor before = ByGroup(Before(hidden0, hidden));
    const at::Tensor d_values = at::bmm(weights.reshape({frames, rows, frames}).permute({1, 2, 0}),
                                        d_gates.reshape({frames, rows, -1}).transpose(0, 1))
                                    .reshape(values.sizes());
    return {d_encoded,
            d_values,
            at::bmm(ByGroup(d_gates).transpose(1, 2), before),
            at::bmm(ByGroup(d_query).transpose(1, 2), before),
            d_score,
            d_hidden,
            d_cell,
            at::Tensor(),
            at::Tensor()};
  }

 private:
  static constexpr double kFarBelow = -1e30;     // makes the weight of padding 0 in the softmax
  static constexpr std::size_t kFirstTanh = 11;  // of the saved tensors: that of the first step
};

}  // namespace

std::pair<at::Tensor, at::Tensor> LstmSequence(const at::Tensor& gates, const at::Tensor& weight_hh,
                                               const at::Tensor& hidden, const at::Tensor& cell) {
  const auto out = LstmFunction::apply(gates, weight_hh, hidden, cell);
  return {out[0], out[1]};
}

at::Tensor AttentiveDecoder(const DecoderInputs& in) {
  // Inference does not store the activations of the attention, the largest of all.
  const bool keeps_tanh = at::GradMode::is_enabled();
  return DecoderFunction::apply(in.encoded, in.values, in.weight_hh, in.state, in.score, in.hidden,
                                in.cell, in.lengths, keeps_tanh);
}

torch::Tensor FrameMask(const torch::Tensor& lengths, int64_t frames) {
  return torch::arange(frames, lengths.options()).unsqueeze(1) < lengths.unsqueeze(0);
}

torch::Tensor ReversedRows(const torch::Tensor& lengths, int64_t frames) {
  const torch::Tensor frame = torch::arange(frames).unsqueeze(1);
  const torch::Tensor turned = lengths.unsqueeze(0) - 1 - frame;
  const torch::Tensor from = torch::where(turned >= 0, turned, frame.expand_as(turned));
  return (from * lengths.size(0) + torch::arange(lengths.size(0)).unsqueeze(0)).flatten();
}

torch::Tensor LastRows(const torch::Tensor& lengths) {
  return (lengths - 1) * lengths.size(0) + torch::arange(lengths.size(0));
}

}  // namespace duet::network
