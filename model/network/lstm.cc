#include "model/network/lstm.h"

#include <torch/torch.h>

#include "model/network/kernels.h"

namespace duet::network {
namespace {

struct Sizes {
  int64_t steps, groups, batch, hidden;
  int rows() const { return static_cast<int>(groups * batch); }
};

Sizes SizesOf(const at::Tensor& gates) {
  return {gates.size(0), gates.size(1), gates.size(2), gates.size(3) / 4};
}

// gates[t] += hidden[t - 1] W_hh^T, then the cells.
template <typename S>
void Forward(const Sizes& sizes, const S* weight_hh, const S* hidden0, const S* cell0, S* gates,
             S* hidden, S* cell) {
  const int64_t n = sizes.batch, h = sizes.hidden, step = sizes.groups * n * h;
  for (int64_t t = 0; t < sizes.steps; ++t) {
    S* gates_t = gates + t * 4 * step;
    const S* hidden_before = t == 0 ? hidden0 : hidden + (t - 1) * step;
    const S* cell_before = t == 0 ? cell0 : cell + (t - 1) * step;
    for (int64_t g = 0; g < sizes.groups; ++g) {
      Gemm(true, static_cast<int>(n), static_cast<int>(4 * h), static_cast<int>(h),
           hidden_before + g * n * h, weight_hh + g * 4 * h * h, S(1), gates_t + g * n * 4 * h);
    }
    LstmCellForward(sizes.rows(), static_cast<int>(h), gates_t, cell_before, cell + t * step,
                    hidden + t * step);
  }
}

template <typename S>
void Backward(const Sizes& sizes, const S* weight_hh, const S* cell0, const S* gates, const S* cell,
              const S* d_hidden_out, const S* d_cell_out, S* d_hidden, S* d_cell, S* d_gates) {
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
           d_gates + t * 4 * step + g * n * 4 * h, weight_hh + g * 4 * h * h, S(0),
           d_hidden + g * n * h);
    }
  }
}

// [T, G, N, X] -> [G, T N, X]
at::Tensor ByGroup(const at::Tensor& x) {
  return x.transpose(0, 1).reshape({x.size(1), x.size(0) * x.size(2), x.size(3)});
}

class LstmFunction : public torch::autograd::Function<LstmFunction> {
 public:
  static torch::autograd::variable_list forward(torch::autograd::AutogradContext* context,
                                                const at::Tensor& input_gates,
                                                const at::Tensor& weight_hh_in,
                                                const at::Tensor& hidden0_in,
                                                const at::Tensor& cell0_in) {
    const Sizes sizes = SizesOf(input_gates);
    at::Tensor gates = input_gates.clone(at::MemoryFormat::Contiguous);
    at::Tensor weight_hh = weight_hh_in.contiguous();
    at::Tensor hidden0 = hidden0_in.contiguous(), cell0 = cell0_in.contiguous();
    at::Tensor hidden =
        at::empty({sizes.steps, sizes.groups, sizes.batch, sizes.hidden}, gates.options());
    at::Tensor cell = at::empty_like(hidden);
    AT_DISPATCH_FLOATING_TYPES(gates.scalar_type(), "LstmSequence", [&] {
      Forward<scalar_t>(sizes, weight_hh.data_ptr<scalar_t>(), hidden0.data_ptr<scalar_t>(),
                        cell0.data_ptr<scalar_t>(), gates.data_ptr<scalar_t>(),
                        hidden.data_ptr<scalar_t>(), cell.data_ptr<scalar_t>());
    });
    context->save_for_backward({gates, weight_hh, hidden0, cell0, hidden, cell});
    return {hidden, cell};
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 torch::autograd::variable_list gradients) {
    const auto saved = context->get_saved_variables();
    const at::Tensor &gates = saved[0], &weight_hh = saved[1], &hidden0 = saved[2],
                     &cell0 = saved[3], &hidden = saved[4], &cell = saved[5];
    const Sizes sizes = SizesOf(gates);
    const at::Tensor d_hidden_out =
        gradients[0].defined() ? gradients[0].contiguous() : at::zeros_like(hidden);
    const at::Tensor d_cell_out =
        gradients[1].defined() ? gradients[1].contiguous() : at::zeros_like(cell);
    at::Tensor d_hidden = at::zeros_like(hidden0), d_cell = at::zeros_like(cell0);
    at::Tensor d_gates = at::empty_like(gates);
    AT_DISPATCH_FLOATING_TYPES(gates.scalar_type(), "LstmSequenceBackward", [&] {
      Backward<scalar_t>(sizes, weight_hh.data_ptr<scalar_t>(), cell0.data_ptr<scalar_t>(),
                         gates.data_ptr<scalar_t>(), cell.data_ptr<scalar_t>(),
                         d_hidden_out.data_ptr<scalar_t>(), d_cell_out.data_ptr<scalar_t>(),
                         d_hidden.data_ptr<scalar_t>(), d_cell.data_ptr<scalar_t>(),
                         d_gates.data_ptr<scalar_t>());
    });
    // One product over all steps instead of one per step.
    const at::Tensor before =
        at::cat({hidden0.unsqueeze(0), hidden.narrow(0, 0, sizes.steps - 1)}, 0);
    const at::Tensor d_weight = at::bmm(ByGroup(d_gates).transpose(1, 2), ByGroup(before));
    return {d_gates, d_weight, d_hidden, d_cell};
  }
};

}  // namespace

std::pair<at::Tensor, at::Tensor> LstmSequence(const at::Tensor& gates, const at::Tensor& weight_hh,
                                               const at::Tensor& hidden, const at::Tensor& cell) {
  const auto out = LstmFunction::apply(gates, weight_hh, hidden, cell);
  return {out[0], out[1]};
}

}  // namespace duet::network
