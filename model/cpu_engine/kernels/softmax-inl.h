// Included once per instruction set, through foreach_target.h.
#if defined(DUET_MODEL_CPU_ENGINE_KERNELS_SOFTMAX_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DUET_MODEL_CPU_ENGINE_KERNELS_SOFTMAX_INL_H_
#undef DUET_MODEL_CPU_ENGINE_KERNELS_SOFTMAX_INL_H_
#else
#define DUET_MODEL_CPU_ENGINE_KERNELS_SOFTMAX_INL_H_
#endif

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

}  // namespace duet::cpu_engine::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
