#include "model/cpu_engine/kernels/additive_attention.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/cpu_engine/kernels/additive_attention.cc"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "model/cpu_engine/kernels/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace duet::cpu_engine::kernels::HWY_NAMESPACE {

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
HWY_INLINE void AddColumns(const Rows& values, const float* weights, int first, float* sums) {
  const Tag d;
  const int valid = values.width - first;
  Vector sum[kVectors];
  for (int v = 0; v < kVectors; ++v) {
    sum[v] = LoadFirst(valid - v * Lanes(), sums + first + v * Lanes());
  }
  const float* HWY_RESTRICT row = values.values + first;
  for (int j = 0; j < values.count; ++j, row += values.stride) {
    const Vector weight = hn::Set(d, weights[j]);
    for (int v = 0; v < kVectors; ++v) {
      sum[v] = hn::MulAdd(weight, LoadFirst(valid - v * Lanes(), row + v * Lanes()), sum[v]);
    }
  }
  for (int v = 0; v < kVectors; ++v) {
    StoreFirst(valid - v * Lanes(), sum[v], sums + first + v * Lanes());
  }
}

void AddAll(const Rows& values, const float* weights, float* sums) {
  constexpr int kAtOnce = 10;
  int first = 0;
  for (; first + kAtOnce * Lanes() <= values.width; first += kAtOnce * Lanes()) {
    AddColumns<kAtOnce>(values, weights, first, sums);
  }
  for (; first < values.width; first += Lanes()) AddColumns<1>(values, weights, first, sums);
}

}  // namespace duet::cpu_engine::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duet::cpu_engine::kernels {

HWY_EXPORT(Weigh);
HWY_EXPORT(AddAll);

void WeighFrames(const AdditiveAttention& attention) { HWY_DYNAMIC_DISPATCH(Weigh)(attention); }
void AddWeighted(const Rows& values, const float* weights, float* sums) {
  HWY_DYNAMIC_DISPATCH(AddAll)(values, weights, sums);
}

}  // namespace duet::cpu_engine::kernels
#endif
