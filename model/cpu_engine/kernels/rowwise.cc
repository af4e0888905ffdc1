#include "model/cpu_engine/kernels/rowwise.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/cpu_engine/kernels/rowwise.cc"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "model/cpu_engine/kernels/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace duet::cpu_engine::kernels::HWY_NAMESPACE {

// The number of values after `at` of `count`, at most one vector.
HWY_INLINE ptrdiff_t Left(ptrdiff_t count, ptrdiff_t at) { return HWY_MIN(count - at, Lanes()); }

void GeluInPlace(ptrdiff_t count, float* HWY_RESTRICT values) {
  const Tag d;
  const Vector half = hn::Set(d, 0.5f), root_half = hn::Set(d, 0.70710678118654752f);
  for (ptrdiff_t i = 0; i < count; i += Lanes()) {
    const Vector x = LoadFirst(Left(count, i), values + i);
    StoreFirst(Left(count, i), half * x * (hn::Set(d, 1.0f) + Erf(x * root_half)), values + i);
  }
}

void SiluInPlace(ptrdiff_t count, float* HWY_RESTRICT values) {
  for (ptrdiff_t i = 0; i < count; i += Lanes()) {
    const Vector x = LoadFirst(Left(count, i), values + i);
    StoreFirst(Left(count, i), x * Sigmoid(x), values + i);
  }
}

void Norm(const NormRow& row) {
  const Tag d;
  Vector sum = hn::Zero(d);
  for (int i = 0; i < row.width; i += Lanes()) sum = sum + LoadFirst(row.width - i, row.x + i);
  const float width = static_cast<float>(row.width);
  const Vector mean = hn::Set(d, hn::GetLane(hn::SumOfLanes(d, sum)) / width);
  Vector squares = hn::Zero(d);
  for (int i = 0; i < row.width; i += Lanes()) {
    const auto valid = hn::FirstN(d, static_cast<size_t>(HWY_MIN(row.width - i, Lanes())));
    const Vector from_mean = hn::IfThenElseZero(valid, LoadFirst(row.width - i, row.x + i) - mean);
    squares = hn::MulAdd(from_mean, from_mean, squares);
  }
  const float variance = hn::GetLane(hn::SumOfLanes(d, squares)) / width;
  const Vector factor = hn::Set(d, 1 / std::sqrt(variance + 1e-5f));
  const Vector offset = hn::Set(d, row.scale_offset);
  for (int i = 0; i < row.width; i += Lanes()) {
    const int valid = row.width - i;
    const Vector normal = (LoadFirst(valid, row.x + i) - mean) * factor;
    const Vector scale = LoadFirst(valid, row.scale + i) + offset;
    StoreFirst(valid, hn::MulAdd(normal, scale, LoadFirst(valid, row.shift + i)), row.out + i);
  }
}

}  // namespace duet::cpu_engine::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duet::cpu_engine::kernels {

HWY_EXPORT(GeluInPlace);
HWY_EXPORT(SiluInPlace);
HWY_EXPORT(Norm);

void Gelu(std::ptrdiff_t count, float* values) { HWY_DYNAMIC_DISPATCH(GeluInPlace)(count, values); }
void Silu(std::ptrdiff_t count, float* values) { HWY_DYNAMIC_DISPATCH(SiluInPlace)(count, values); }
void LayerNorm(const NormRow& row) { HWY_DYNAMIC_DISPATCH(Norm)(row); }

}  // namespace duet::cpu_engine::kernels
#endif
