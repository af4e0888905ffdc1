#include "model/cpu_engine/kernels/lstm_cell.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/cpu_engine/kernels/lstm_cell.cc"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "model/cpu_engine/kernels/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace duet::cpu_engine::kernels::HWY_NAMESPACE {

// The gates of one row; either part may be absent.
struct Gates {
  const float* recurrent;
  const float* input;

  HWY_INLINE Vector Load(int valid, int at) const {
    const Vector a = recurrent == nullptr ? hn::Zero(Tag()) : LoadFirst(valid, recurrent + at);
    return input == nullptr ? a : a + LoadFirst(valid, input + at);
  }
};

void Cells(const LstmStep& step) {
  const int hidden = step.hidden;
  for (int row = 0; row < step.count; ++row) {
    const Gates gates{step.gates == nullptr ? nullptr : step.gates + row * step.gates_stride,
                      step.inputs == nullptr ? nullptr : step.inputs[row]};
    float* const state = step.state + row * step.state_stride;
    float* const cell = step.cell + row * step.state_stride;
    for (int u = 0; u < hidden; u += Lanes()) {
      const int valid = hidden - u;
      const Vector i = Sigmoid(gates.Load(valid, u)), f = Sigmoid(gates.Load(valid, hidden + u));
      const Vector g = Tanh(gates.Load(valid, 2 * hidden + u));
      const Vector o = Sigmoid(gates.Load(valid, 3 * hidden + u));
      const Vector after = hn::MulAdd(f, LoadFirst(valid, cell + u), i * g);
      const Vector out = o * Tanh(after);
      StoreFirst(valid, after, cell + u);
      StoreFirst(valid, out, state + u);
      StoreFirst(valid, out, step.outputs[row] + u);
    }
  }
}

}  // namespace duet::cpu_engine::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duet::cpu_engine::kernels {

HWY_EXPORT(Cells);

void LstmCells(const LstmStep& step) { HWY_DYNAMIC_DISPATCH(Cells)(step); }

}  // namespace duet::cpu_engine::kernels
#endif
