#include "model/cpu_engine/kernels/additive_attention.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/cpu_engine/kernels/additive_attention.cc"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "model/cpu_engine/kernels/softmax-inl.h"
#include "model/cpu_engine/kernels/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace duet::cpu_engine::kernels {
namespace HWY_NAMESPACE {

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

// kVectors vectors of the weighted sum, kept in registers over all frames.
template <int kVectors>
HWY_INLINE void AddWeighted(const AdditiveAttention& in, int first) {
  const Tag d;
  const int valid = in.width - first;
  Vector sums[kVectors];
  for (int v = 0; v < kVectors; ++v) {
    sums[v] = LoadFirst(valid - v * Lanes(), in.sums + first + v * Lanes());
  }
  const float* HWY_RESTRICT values = in.values + first;
  for (int j = 0; j < in.frames; ++j, values += in.width) {
    const Vector weight = hn::Set(d, in.weights[j]);
    for (int v = 0; v < kVectors; ++v) {
      sums[v] = hn::MulAdd(weight, LoadFirst(valid - v * Lanes(), values + v * Lanes()), sums[v]);
    }
  }
  for (int v = 0; v < kVectors; ++v) {
    StoreFirst(valid - v * Lanes(), sums[v], in.sums + first + v * Lanes());
  }
}

void AttendTo(const AdditiveAttention& in) {
  for (int j = 0; j < in.frames; ++j) {
    in.weights[j] = Energy(in, in.encoded + static_cast<ptrdiff_t>(j) * in.attention);
  }
  Softmax(in.frames, in.weights);
  constexpr int kAtOnce = 10;
  int first = 0;
  for (; first + kAtOnce * Lanes() <= in.width; first += kAtOnce * Lanes()) {
    AddWeighted<kAtOnce>(in, first);
  }
  for (; first < in.width; first += Lanes()) AddWeighted<1>(in, first);
}

}  // namespace HWY_NAMESPACE
}  // namespace duet::cpu_engine::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duet::cpu_engine::kernels {

HWY_EXPORT(AttendTo);

void Attend(const AdditiveAttention& attention) { HWY_DYNAMIC_DISPATCH(AttendTo)(attention); }

}  // namespace duet::cpu_engine::kernels
#endif
