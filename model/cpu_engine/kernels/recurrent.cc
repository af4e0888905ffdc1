#include "model/cpu_engine/kernels/recurrent.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/cpu_engine/kernels/recurrent.cc"
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

// Turns `count` values, at least 1, into weights with the sum 1.
HWY_INLINE void Softmax(int count, float* HWY_RESTRICT values) {
  const Tag d;
  const Vector lowest = hn::Set(d, -3e38f);
  Vector largest = lowest;
  for (int j = 0; j < count; j += Lanes()) {
    const auto valid = hn::FirstN(d, static_cast<size_t>(HWY_MIN(count - j, Lanes())));
    largest = hn::Max(largest, hn::IfThenElse(valid, LoadFirst(count - j, values + j), lowest));
  }
  largest = hn::MaxOfLanes(d, largest);
  Vector sum = hn::Zero(d);
  for (int j = 0; j < count; j += Lanes()) {
    const auto valid = hn::FirstN(d, static_cast<size_t>(HWY_MIN(count - j, Lanes())));
    const Vector e = hn::IfThenElseZero(valid, Exp(LoadFirst(count - j, values + j) - largest));
    sum = sum + e;
    StoreFirst(count - j, e, values + j);
  }
  const Vector share = hn::Set(d, 1.0f) / hn::SumOfLanes(d, sum);
  for (int j = 0; j < count; j += Lanes()) {
    StoreFirst(count - j, LoadFirst(count - j, values + j) * share, values + j);
  }
}

HWY_INLINE float Energy(const AdditiveAttention& in, const float* HWY_RESTRICT encoded) {
  const Tag d;
  Vector sum = hn::Zero(d);
  for (int a = 0; a < in.attention; a += Lanes()) {
    const int valid = in.attention - a;
    const Vector tanh = Tanh(LoadFirst(valid, encoded + a) + LoadFirst(valid, in.query + a));
    sum = hn::MulAdd(LoadFirst(valid, in.score + a), tanh, sum);
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

void Weigh(const AdditiveAttention& in) {
  for (int j = 0; j < in.frames; ++j) {
    in.weights[j] = Energy(in, in.encoded + static_cast<ptrdiff_t>(j) * in.attention);
  }
  Softmax(in.frames, in.weights);
}

// Computes kVectors vectors of the weighted sum from column `first` on, in registers over all rows.
template <int kVectors>
HWY_INLINE void AddColumns(int frames, int width, const float* values, const float* weights,
                           int first, float* sums) {
  const Tag d;
  const int valid = width - first;
  Vector sum[kVectors];
  for (int v = 0; v < kVectors; ++v) {
    sum[v] = LoadFirst(valid - v * Lanes(), sums + first + v * Lanes());
  }
  const float* HWY_RESTRICT row = values + first;
  for (int j = 0; j < frames; ++j, row += width) {
    const Vector weight = hn::Set(d, weights[j]);
    for (int v = 0; v < kVectors; ++v) {
      sum[v] = hn::MulAdd(weight, LoadFirst(valid - v * Lanes(), row + v * Lanes()), sum[v]);
    }
  }
  for (int v = 0; v < kVectors; ++v) {
    StoreFirst(valid - v * Lanes(), sum[v], sums + first + v * Lanes());
  }
}

void AddAll(int frames, int width, const float* values, const float* weights, float* sums) {
  constexpr int kAtOnce = 10;
  int first = 0;
  for (; first + kAtOnce * Lanes() <= width; first += kAtOnce * Lanes()) {
    AddColumns<kAtOnce>(frames, width, values, weights, first, sums);
  }
  for (; first < width; first += Lanes()) {
    AddColumns<1>(frames, width, values, weights, first, sums);
  }
}

}  // namespace duet::cpu_engine::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duet::cpu_engine::kernels {

HWY_EXPORT(Cells);
HWY_EXPORT(Weigh);
HWY_EXPORT(AddAll);

void LstmCells(const LstmStep& step) { HWY_DYNAMIC_DISPATCH(Cells)(step); }
void WeighFrames(const AdditiveAttention& attention) { HWY_DYNAMIC_DISPATCH(Weigh)(attention); }
void AddWeighted(int frames, int width, const float* values, const float* weights, float* sums) {
  HWY_DYNAMIC_DISPATCH(AddAll)(frames, width, values, weights, sums);
}

}  // namespace duet::cpu_engine::kernels
#endif
