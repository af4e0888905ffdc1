#include "model/network/attentive_decoder.h"

#include <torch/torch.h>

#include <vector>

#include "model/network/kernels.h"

namespace duet::network {
namespace {

struct Sizes {
  int groups, batch, frames, attention, hidden;
  int rows() const { return groups * batch; }
  int64_t state() const { return int64_t{1} * rows() * hidden; }
  int64_t query() const { return int64_t{1} * rows() * attention; }
  int64_t weights() const { return int64_t{1} * rows() * frames; }
};

// Raw pointers to the inputs of both passes.
template <typename S>
struct Inputs {
  const S *encoded, *values, *weight_hh, *state, *score, *hidden0, *cell0;
  const int64_t* lengths;
};

// Intermediate values of the forward pass, one block per step.
template <typename S>
struct Trace {
  S* tanh_values;  // [T, G, N, T, A], or one row's [T, A] without a gradient
  S* weights;      // [T, G, N, T]
  S* gates;        // [T, G, N, 4 H] activations
  S* hidden;       // [T, G, N, H]
  S* cell;         // [T, G, N, H]
};

template <typename S>
void Forward(const Sizes& z, const Inputs<S>& in, bool keep_tanh, const Trace<S>& out) {
  const int64_t tanh_row = int64_t{1} * z.frames * z.attention;
  std::vector<S> query(static_cast<size_t>(z.query()));
  for (int t = 0; t < z.frames; ++t) {
    const S* hidden_before = t == 0 ? in.hidden0 : out.hidden + (t - 1) * z.state();
    const S* cell_before = t == 0 ? in.cell0 : out.cell + (t - 1) * z.state();
    S* gates = out.gates + t * 4 * z.state();
    for (int g = 0; g < z.groups; ++g) {
      Gemm(true, z.batch, z.attention, z.hidden, hidden_before + int64_t{g} * z.batch * z.hidden,
           in.state + int64_t{g} * z.attention * z.hidden, S(0),
           query.data() + int64_t{g} * z.batch * z.attention);
    }
    for (int row = 0; row < z.rows(); ++row) {
      S* weights = out.weights + t * z.weights() + int64_t{row} * z.frames;
      const int valid = static_cast<int>(in.lengths[row % z.batch]);
      AttentionForward(z.frames, valid, z.attention, in.encoded + row * tanh_row,
                       query.data() + int64_t{row} * z.attention,
                       in.score + int64_t{row / z.batch} * z.attention,
                       out.tanh_values + (keep_tanh ? (int64_t{t} * z.rows() + row) * tanh_row : 0),
                       weights);
      VectorMatrix(valid, 4 * z.hidden, weights, in.values + int64_t{row} * z.frames * 4 * z.hidden,
                   S(0), gates + int64_t{row} * 4 * z.hidden);
    }
    for (int g = 0; g < z.groups; ++g) {
      Gemm(true, z.batch, 4 * z.hidden, z.hidden, hidden_before + int64_t{g} * z.batch * z.hidden,
           in.weight_hh + int64_t{g} * 4 * z.hidden * z.hidden, S(1),
           gates + int64_t{g} * z.batch * 4 * z.hidden);
    }
    LstmCellForward(z.rows(), z.hidden, gates, cell_before, out.cell + t * z.state(),
                    out.hidden + t * z.state());
  }
}

template <typename S>
struct Gradients {
  const S* d_out;  // [T, G, N, H] in
  S* d_encoded;    // [G, N, T, A] accumulated
  S* d_score;      // [G, A] accumulated
  S* d_hidden;     // [G, N, H] running; finally that of the initial state
  S* d_cell;       // [G, N, H] likewise
  S* d_gates;      // [T, G, N, 4 H]
  S* d_query;      // [T, G, N, A]
};

template <typename S>
void Backward(const Sizes& z, const Inputs<S>& in, const Trace<S>& trace, const Gradients<S>& out) {
  const int64_t tanh_row = int64_t{1} * z.frames * z.attention;
  std::vector<S> d_weights(static_cast<size_t>(z.frames));
  for (int t = z.frames - 1; t >= 0; --t) {
    for (int64_t i = 0; i < z.state(); ++i) out.d_hidden[i] += out.d_out[t * z.state() + i];
    S* d_gates = out.d_gates + t * 4 * z.state();
    S* d_query = out.d_query + t * z.query();
    LstmCellBackward(z.rows(), z.hidden, trace.gates + t * 4 * z.state(),
                     t == 0 ? in.cell0 : trace.cell + (t - 1) * z.state(),
                     trace.cell + t * z.state(), out.d_hidden, out.d_cell, d_gates);
    for (int row = 0; row < z.rows(); ++row) {
      const int valid = static_cast<int>(in.lengths[row % z.batch]);
      MatrixVector(valid, 4 * z.hidden, in.values + int64_t{row} * z.frames * 4 * z.hidden,
                   d_gates + int64_t{row} * 4 * z.hidden, d_weights.data());
      AttentionBackward(valid, z.attention,
                        trace.tanh_values + (int64_t{t} * z.rows() + row) * tanh_row,
                        trace.weights + t * z.weights() + int64_t{row} * z.frames,
                        in.score + int64_t{row / z.batch} * z.attention, d_weights.data(),
                        out.d_encoded + row * tanh_row, d_query + int64_t{row} * z.attention,
                        out.d_score + int64_t{row / z.batch} * z.attention);
    }
    for (int g = 0; g < z.groups; ++g) {
      S* d_hidden = out.d_hidden + int64_t{g} * z.batch * z.hidden;
      Gemm(false, z.batch, z.hidden, 4 * z.hidden, d_gates + int64_t{g} * z.batch * 4 * z.hidden,
           in.weight_hh + int64_t{g} * 4 * z.hidden * z.hidden, S(0), d_hidden);
      Gemm(false, z.batch, z.hidden, z.attention, d_query + int64_t{g} * z.batch * z.attention,
           in.state + int64_t{g} * z.attention * z.hidden, S(1), d_hidden);
    }
  }
}

template <typename S>
Inputs<S> Raw(const torch::autograd::variable_list& tensors) {
  return {tensors[0].data_ptr<S>(), tensors[1].data_ptr<S>(),      tensors[2].data_ptr<S>(),
          tensors[3].data_ptr<S>(), tensors[4].data_ptr<S>(),      tensors[5].data_ptr<S>(),
          tensors[6].data_ptr<S>(), tensors[7].data_ptr<int64_t>()};
}

template <typename S>
Trace<S> Raw(const std::array<at::Tensor, 5>& trace) {
  return {trace[0].data_ptr<S>(), trace[1].data_ptr<S>(), trace[2].data_ptr<S>(),
          trace[3].data_ptr<S>(), trace[4].data_ptr<S>()};
}

Sizes SizesOf(const at::Tensor& encoded, const at::Tensor& hidden) {
  return {static_cast<int>(encoded.size(0)), static_cast<int>(encoded.size(1)),
          static_cast<int>(encoded.size(2)), static_cast<int>(encoded.size(3)),
          static_cast<int>(hidden.size(2))};
}

// [T, G, N, X] -> [G, T N, X]
at::Tensor ByGroup(const at::Tensor& x) {
  return x.transpose(0, 1).reshape({x.size(1), x.size(0) * x.size(2), x.size(3)});
}

std::array<at::Tensor, 5> MakeTrace(const Sizes& z, bool keep_tanh, const at::TensorOptions& o) {
  const int64_t steps = z.frames;
  return {keep_tanh ? at::empty({steps, z.groups, z.batch, z.frames, z.attention}, o)
                    : at::empty({z.frames, z.attention}, o),
          at::empty({steps, z.groups, z.batch, z.frames}, o),
          at::empty({steps, z.groups, z.batch, 4 * z.hidden}, o),
          at::empty({steps, z.groups, z.batch, z.hidden}, o),
          at::empty({steps, z.groups, z.batch, z.hidden}, o)};
}

class DecoderFunction : public torch::autograd::Function<DecoderFunction> {
 public:
  static at::Tensor forward(torch::autograd::AutogradContext* context, const at::Tensor& encoded,
                            const at::Tensor& values, const at::Tensor& weight_hh,
                            const at::Tensor& state, const at::Tensor& score,
                            const at::Tensor& hidden0, const at::Tensor& cell0,
                            const at::Tensor& lengths, bool keep_tanh) {
    const torch::autograd::variable_list inputs = {
        encoded.contiguous(), values.contiguous(),  weight_hh.contiguous(), state.contiguous(),
        score.contiguous(),   hidden0.contiguous(), cell0.contiguous(),     lengths.contiguous()};
    const Sizes sizes = SizesOf(encoded, hidden0);
    const std::array<at::Tensor, 5> trace = MakeTrace(sizes, keep_tanh, encoded.options());
    AT_DISPATCH_FLOATING_TYPES(encoded.scalar_type(), "AttentiveDecoder", [&] {
      Forward<scalar_t>(sizes, Raw<scalar_t>(inputs), keep_tanh, Raw<scalar_t>(trace));
    });
    if (keep_tanh) {
      torch::autograd::variable_list saved = inputs;
      saved.insert(saved.end(), trace.begin(), trace.end());
      context->save_for_backward(saved);
    }
    return trace[3];
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 torch::autograd::variable_list gradients) {
    const auto saved = context->get_saved_variables();
    const std::array<at::Tensor, 5> trace = {saved[8], saved[9], saved[10], saved[11], saved[12]};
    const at::Tensor &encoded = saved[0], &values = saved[1], &score = saved[4],
                     &hidden0 = saved[5], &weights = trace[1], &hidden = trace[3];
    const Sizes sizes = SizesOf(encoded, hidden0);
    const at::Tensor d_out = gradients[0].contiguous();
    at::Tensor d_encoded = at::zeros_like(encoded), d_score = at::zeros_like(score);
    at::Tensor d_hidden = at::zeros_like(hidden0), d_cell = at::zeros_like(hidden0);
    at::Tensor d_gates = at::empty_like(trace[2]);
    at::Tensor d_query =
        at::empty({sizes.frames, sizes.groups, sizes.batch, sizes.attention}, encoded.options());
    AT_DISPATCH_FLOATING_TYPES(encoded.scalar_type(), "AttentiveDecoderBackward", [&] {
      Backward<scalar_t>(
          sizes, Raw<scalar_t>(saved), Raw<scalar_t>(trace),
          {d_out.data_ptr<scalar_t>(), d_encoded.data_ptr<scalar_t>(), d_score.data_ptr<scalar_t>(),
           d_hidden.data_ptr<scalar_t>(), d_cell.data_ptr<scalar_t>(), d_gates.data_ptr<scalar_t>(),
           d_query.data_ptr<scalar_t>()});
    });
    // Sums over the steps are one product over all steps.
    const at::Tensor before = ByGroup(at::cat({hidden0.unsqueeze(0), hidden.slice(0, 0, -1)}, 0));
    const at::Tensor d_weight_hh = at::bmm(ByGroup(d_gates).transpose(1, 2), before);
    const at::Tensor d_state = at::bmm(ByGroup(d_query).transpose(1, 2), before);
    const int64_t rows = sizes.rows(), steps = sizes.frames;
    const at::Tensor d_values =
        at::bmm(weights.reshape({steps, rows, sizes.frames}).permute({1, 2, 0}),
                d_gates.reshape({steps, rows, 4 * sizes.hidden}).transpose(0, 1))
            .reshape(values.sizes());
    return {d_encoded, d_values, d_weight_hh,  d_state,     d_score,
            d_hidden,  d_cell,   at::Tensor(), at::Tensor()};
  }
};

}  // namespace

at::Tensor AttentiveDecoder(const DecoderInputs& in) {
  // Inference does not store the activations of the attention, the largest of all.
  const bool keep_tanh = at::GradMode::is_enabled();
  return DecoderFunction::apply(in.encoded, in.values, in.weight_hh, in.state, in.score, in.hidden,
                                in.cell, in.lengths, keep_tanh);
}

}  // namespace duet::network
