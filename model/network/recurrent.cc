#include "model/network/recurrent.h"

#include <array>
#include <vector>

#include "model/network/kernels.h"

namespace duet::network {
namespace {

// [T, G, N, X] -> [G, T N, X]
at::Tensor ByGroup(const at::Tensor& x) {
  return x.transpose(0, 1).reshape({x.size(1), x.size(0) * x.size(2), x.size(3)});
}

struct LstmSizes {
  int64_t steps, groups, batch, hidden;
  int rows() const { return static_cast<int>(groups * batch); }
};

LstmSizes SizesOf(const at::Tensor& gates) {
  return {gates.size(0), gates.size(1), gates.size(2), gates.size(3) / 4};
}

// gates[t] += hidden[t - 1] W_hh^T, then the cells.
void Forward(const LstmSizes& sizes, const float* weight_hh, const float* hidden0,
             const float* cell0, float* gates, float* hidden, float* cell) {
  const int64_t n = sizes.batch, h = sizes.hidden, step = sizes.groups * n * h;
  for (int64_t t = 0; t < sizes.steps; ++t) {
    float* gates_t = gates + t * 4 * step;
    const float* hidden_before = t == 0 ? hidden0 : hidden + (t - 1) * step;
    const float* cell_before = t == 0 ? cell0 : cell + (t - 1) * step;
    for (int64_t g = 0; g < sizes.groups; ++g) {
      Gemm(true, static_cast<int>(n), static_cast<int>(4 * h), static_cast<int>(h),
           hidden_before + g * n * h, weight_hh + g * 4 * h * h, 1, gates_t + g * n * 4 * h);
    }
    LstmCellForward(sizes.rows(), static_cast<int>(h), gates_t, cell_before, cell + t * step,
                    hidden + t * step);
  }
}

void Backward(const LstmSizes& sizes, const float* weight_hh, const float* cell0,
              const float* gates, const float* cell, const float* d_hidden_out,
              const float* d_cell_out, float* d_hidden, float* d_cell, float* d_gates) {
  const int64_t n = sizes.batch, h = sizes.hidden, step = sizes.groups * n * h;
  for (int64_t t = sizes.steps - 1; t >= 0; --t) {
    for (int64_t i = 0; i < step; ++i) {
      d_hidden[i] += d_hidden_out[t * step + i];
      d_cell[i] += d_cell_out[t * step + i];
    }
    LstmCellBackward(sizes.rows(), static_cast<int>(h), gates + t * 4 * step,
                     t == 0 ? cell0 : cell + (t - 1) * step, cell + t * step, d_hidden, d_cell,
                     d_gates + t * 4 * step);
    for (int64_t g = 0; g < sizes.groups; ++g) {
      Gemm(false, static_cast<int>(n), static_cast<int>(h), static_cast<int>(4 * h),
           d_gates + t * 4 * step + g * n * 4 * h, weight_hh + g * 4 * h * h, 0,
           d_hidden + g * n * h);
    }
  }
}

class LstmFunction : public torch::autograd::Function<LstmFunction> {
 public:
  static torch::autograd::variable_list forward(torch::autograd::AutogradContext* context,
                                                const at::Tensor& input_gates,
                                                const at::Tensor& weight_hh_in,
                                                const at::Tensor& hidden0_in,
                                                const at::Tensor& cell0_in) {
    const LstmSizes sizes = SizesOf(input_gates);
    at::Tensor gates = input_gates.clone(at::MemoryFormat::Contiguous);
    at::Tensor weight_hh = weight_hh_in.contiguous();
    at::Tensor hidden0 = hidden0_in.contiguous(), cell0 = cell0_in.contiguous();
    at::Tensor hidden =
        at::empty({sizes.steps, sizes.groups, sizes.batch, sizes.hidden}, gates.options());
    at::Tensor cell = at::empty_like(hidden);
    Forward(sizes, weight_hh.data_ptr<float>(), hidden0.data_ptr<float>(), cell0.data_ptr<float>(),
            gates.data_ptr<float>(), hidden.data_ptr<float>(), cell.data_ptr<float>());
    context->save_for_backward({gates, weight_hh, hidden0, cell0, hidden, cell});
    return {hidden, cell};
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 torch::autograd::variable_list gradients) {
    const auto saved = context->get_saved_variables();
    const at::Tensor &gates = saved[0], &weight_hh = saved[1], &hidden0 = saved[2],
                     &cell0 = saved[3], &hidden = saved[4], &cell = saved[5];
    const LstmSizes sizes = SizesOf(gates);
    const at::Tensor d_hidden_out =
        gradients[0].defined() ? gradients[0].contiguous() : at::zeros_like(hidden);
    const at::Tensor d_cell_out =
        gradients[1].defined() ? gradients[1].contiguous() : at::zeros_like(cell);
    at::Tensor d_hidden = at::zeros_like(hidden0), d_cell = at::zeros_like(cell0);
    at::Tensor d_gates = at::empty_like(gates);
    Backward(sizes, weight_hh.data_ptr<float>(), cell0.data_ptr<float>(), gates.data_ptr<float>(),
             cell.data_ptr<float>(), d_hidden_out.data_ptr<float>(), d_cell_out.data_ptr<float>(),
             d_hidden.data_ptr<float>(), d_cell.data_ptr<float>(), d_gates.data_ptr<float>());
    // One product over all steps instead of one per step.
    const at::Tensor before =
        at::cat({hidden0.unsqueeze(0), hidden.narrow(0, 0, sizes.steps - 1)}, 0);
    const at::Tensor d_weight = at::bmm(ByGroup(d_gates).transpose(1, 2), ByGroup(before));
    return {d_gates, d_weight, d_hidden, d_cell};
  }
};

struct Sizes {
  int groups, batch, frames, attention, hidden;
  int rows() const { return groups * batch; }
  int64_t state() const { return int64_t{1} * rows() * hidden; }
  int64_t query() const { return int64_t{1} * rows() * attention; }
  int64_t weights() const { return int64_t{1} * rows() * frames; }
};

// Raw pointers to the inputs of both passes.
struct Inputs {
  const float *encoded, *values, *weight_hh, *state, *score, *hidden0, *cell0;
  const int64_t* lengths;
};

// Intermediate values of the forward pass, one block per step.
struct Trace {
  float* tanh_values;  // [T, G, N, T, A], or one row's [T, A] without a gradient
  float* weights;      // [T, G, N, T]
  float* gates;        // [T, G, N, 4 H] activations
  float* hidden;       // [T, G, N, H]
  float* cell;         // [T, G, N, H]
};

void Forward(const Sizes& z, const Inputs& in, bool keep_tanh, const Trace& out) {
  const int64_t tanh_row = int64_t{1} * z.frames * z.attention;
  std::vector<float> query(static_cast<size_t>(z.query()));
  for (int t = 0; t < z.frames; ++t) {
    const float* hidden_before = t == 0 ? in.hidden0 : out.hidden + (t - 1) * z.state();
    const float* cell_before = t == 0 ? in.cell0 : out.cell + (t - 1) * z.state();
    float* gates = out.gates + t * 4 * z.state();
    for (int g = 0; g < z.groups; ++g) {
      Gemm(true, z.batch, z.attention, z.hidden, hidden_before + int64_t{g} * z.batch * z.hidden,
           in.state + int64_t{g} * z.attention * z.hidden, 0,
           query.data() + int64_t{g} * z.batch * z.attention);
    }
    for (int row = 0; row < z.rows(); ++row) {
      float* weights = out.weights + t * z.weights() + int64_t{row} * z.frames;
      const int valid = static_cast<int>(in.lengths[row % z.batch]);
      AttentionForward(z.frames, valid, z.attention, in.encoded + row * tanh_row,
                       query.data() + int64_t{row} * z.attention,
                       in.score + int64_t{row / z.batch} * z.attention,
                       out.tanh_values + (keep_tanh ? (int64_t{t} * z.rows() + row) * tanh_row : 0),
                       weights);
      VectorMatrix(valid, 4 * z.hidden, weights, in.values + int64_t{row} * z.frames * 4 * z.hidden,
                   0, gates + int64_t{row} * 4 * z.hidden);
    }
    for (int g = 0; g < z.groups; ++g) {
      Gemm(true, z.batch, 4 * z.hidden, z.hidden, hidden_before + int64_t{g} * z.batch * z.hidden,
           in.weight_hh + int64_t{g} * 4 * z.hidden * z.hidden, 1,
           gates + int64_t{g} * z.batch * 4 * z.hidden);
    }
    LstmCellForward(z.rows(), z.hidden, gates, cell_before, out.cell + t * z.state(),
                    out.hidden + t * z.state());
  }
}

struct Gradients {
  const float* d_out;  // [T, G, N, H] in
  float* d_encoded;    // [G, N, T, A] accumulated
  float* d_score;      // [G, A] accumulated
  float* d_hidden;     // [G, N, H] running; finally that of the initial state
  float* d_cell;       // [G, N, H] likewise
  float* d_gates;      // [T, G, N, 4 H]
  float* d_query;      // [T, G, N, A]
};

void Backward(const Sizes& z, const Inputs& in, const Trace& trace, const Gradients& out) {
  const int64_t tanh_row = int64_t{1} * z.frames * z.attention;
  std::vector<float> d_weights(static_cast<size_t>(z.frames));
  for (int t = z.frames - 1; t >= 0; --t) {
    for (int64_t i = 0; i < z.state(); ++i) out.d_hidden[i] += out.d_out[t * z.state() + i];
    float* d_gates = out.d_gates + t * 4 * z.state();
    float* d_query = out.d_query + t * z.query();
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
      float* d_hidden = out.d_hidden + int64_t{g} * z.batch * z.hidden;
      Gemm(false, z.batch, z.hidden, 4 * z.hidden, d_gates + int64_t{g} * z.batch * 4 * z.hidden,
           in.weight_hh + int64_t{g} * 4 * z.hidden * z.hidden, 0, d_hidden);
      Gemm(false, z.batch, z.hidden, z.attention, d_query + int64_t{g} * z.batch * z.attention,
           in.state + int64_t{g} * z.attention * z.hidden, 1, d_hidden);
    }
  }
}

Inputs Raw(const torch::autograd::variable_list& tensors) {
  return {tensors[0].data_ptr<float>(), tensors[1].data_ptr<float>(),  tensors[2].data_ptr<float>(),
          tensors[3].data_ptr<float>(), tensors[4].data_ptr<float>(),  tensors[5].data_ptr<float>(),
          tensors[6].data_ptr<float>(), tensors[7].data_ptr<int64_t>()};
}

Trace Raw(const std::array<at::Tensor, 5>& trace) {
  return {trace[0].data_ptr<float>(), trace[1].data_ptr<float>(), trace[2].data_ptr<float>(),
          trace[3].data_ptr<float>(), trace[4].data_ptr<float>()};
}

Sizes SizesOf(const at::Tensor& encoded, const at::Tensor& hidden) {
  return {static_cast<int>(encoded.size(0)), static_cast<int>(encoded.size(1)),
          static_cast<int>(encoded.size(2)), static_cast<int>(encoded.size(3)),
          static_cast<int>(hidden.size(2))};
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
    Forward(sizes, Raw(inputs), keep_tanh, Raw(trace));
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
    Backward(sizes, Raw(saved), Raw(trace),
             {d_out.data_ptr<float>(), d_encoded.data_ptr<float>(), d_score.data_ptr<float>(),
              d_hidden.data_ptr<float>(), d_cell.data_ptr<float>(), d_gates.data_ptr<float>(),
              d_query.data_ptr<float>()});
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

std::pair<at::Tensor, at::Tensor> LstmSequence(const at::Tensor& gates, const at::Tensor& weight_hh,
                                               const at::Tensor& hidden, const at::Tensor& cell) {
  const auto out = LstmFunction::apply(gates, weight_hh, hidden, cell);
  return {out[0], out[1]};
}

at::Tensor AttentiveDecoder(const DecoderInputs& in) {
  // Inference does not store the activations of the attention, the largest of all.
  const bool keep_tanh = at::GradMode::is_enabled();
  return DecoderFunction::apply(in.encoded, in.values, in.weight_hh, in.state, in.score, in.hidden,
                                in.cell, in.lengths, keep_tanh);
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
