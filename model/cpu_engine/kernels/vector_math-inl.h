// Included once per instruction set, through foreach_target.h.
#if defined(DUET_MODEL_CPU_ENGINE_KERNELS_VECTOR_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DUET_MODEL_CPU_ENGINE_KERNELS_VECTOR_MATH_INL_H_
#undef DUET_MODEL_CPU_ENGINE_KERNELS_VECTOR_MATH_INL_H_
#else
#define DUET_MODEL_CPU_ENGINE_KERNELS_VECTOR_MATH_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duet::cpu_engine::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, 16>;
using Vector = hn::Vec<Tag>;

inline ptrdiff_t Lanes() { return static_cast<ptrdiff_t>(hn::Lanes(Tag())); }

// Whether a masked load or store only accesses the masked values. Before AVX2, Highway's versions
// access a whole vector and require it to be aligned.
constexpr bool kMasksMemory = HWY_TARGET <= HWY_AVX2;

// Loads the first `valid` values, then zeros; at most a whole vector.
HWY_INLINE Vector LoadFirst(ptrdiff_t valid, const float* from) {
  const Tag d;
  if (valid >= Lanes()) return hn::LoadU(d, from);
  if constexpr (kMasksMemory) {
    return hn::MaskedLoad(hn::FirstN(d, static_cast<size_t>(valid)), d, from);
  } else {
    HWY_ALIGN float whole[hn::MaxLanes(d)] = {};
    for (ptrdiff_t i = 0; i < valid; ++i) whole[i] = from[i];
    return hn::Load(d, whole);
  }
}

HWY_INLINE void StoreFirst(ptrdiff_t valid, Vector v, float* to) {
  const Tag d;
  if (valid >= Lanes()) return hn::StoreU(v, d, to);
  if constexpr (kMasksMemory) {
    hn::BlendedStore(v, hn::FirstN(d, static_cast<size_t>(valid)), d, to);
  } else {
    HWY_ALIGN float whole[hn::MaxLanes(d)];
    hn::Store(v, d, whole);
    for (ptrdiff_t i = 0; i < valid; ++i) to[i] = whole[i];
  }
}

// 1 / x, to one or two units in the last place. Requires a finite x that is neither 0 nor tiny.
HWY_INLINE Vector Reciprocal(Vector x) {
  const Tag d;
  const Vector guess = hn::ApproximateReciprocal(x);
  const Vector two = hn::Set(d, 2.0f);
  const Vector better = guess * hn::NegMulAdd(guess, x, two);
  // Narrow vectors start with eleven bits only: one more iteration.
  return HWY_TARGET <= HWY_AVX3 ? better : better * hn::NegMulAdd(better, x, two);
}

// 2^x, relative error below 2e-7; x is within [-126, 127].
// Source: Moshier's Cephes library (exp2f): a polynomial for the fraction, within one half, and the
// exponent for the rest.
HWY_INLINE Vector Exp2(Vector x) {
  const Tag d;
  const hn::RebindToSigned<Tag> di;
  const Vector n = hn::Round(x), r = x - n;
  Vector p = hn::Set(d, 1.535336188319500e-4f);
  p = hn::MulAdd(p, r, hn::Set(d, 1.339887440266574e-3f));
  p = hn::MulAdd(p, r, hn::Set(d, 9.618437357674640e-3f));
  p = hn::MulAdd(p, r, hn::Set(d, 5.550332471162809e-2f));
  p = hn::MulAdd(p, r, hn::Set(d, 2.402264791363012e-1f));
  p = hn::MulAdd(p, r, hn::Set(d, 6.931472028550421e-1f));
  p = hn::MulAdd(p, r, hn::Set(d, 1.0f));
  const auto exponent = hn::ShiftLeft<23>(hn::ConvertTo(di, n));
  return hn::BitCast(d, hn::BitCast(di, p) + exponent);
}

constexpr float kLog2E = 1.44269504088896341f;

HWY_INLINE Vector Within(float low, Vector x, float high) {
  return hn::Min(hn::Max(x, hn::Set(Tag(), low)), hn::Set(Tag(), high));
}

// e^x, relative error below 2e-7 near 0 and 1e-5 at the ends; x is clamped to [-87, 88].
HWY_INLINE Vector Exp(Vector x) { return Exp2(hn::Set(Tag(), kLog2E) * Within(-87, x, 88)); }

HWY_INLINE Vector Sigmoid(Vector x) {
  const Vector one = hn::Set(Tag(), 1.0f);
  return Reciprocal(one + Exp(hn::Neg(x)));
}

// Absolute error below 3e-7.
HWY_INLINE Vector Tanh(Vector x) {
  const Tag d;
  const Vector one = hn::Set(d, 1.0f);
  // Beyond 10 the result is 1 in float; clamping keeps the reciprocal's argument small.
  const Vector squared = Exp2(hn::Set(d, 2 * kLog2E) * Within(-10, x, 10));
  return hn::NegMulAdd(hn::Set(d, 2.0f), Reciprocal(squared + one), one);
}

// The error function, absolute error below 3e-7.
// Source: Abramowitz, Stegun 1964, 7.1.26.
HWY_INLINE Vector Erf(Vector x) {
  const Tag d;
  const Vector one = hn::Set(d, 1.0f), size = hn::Abs(x);
  const Vector t = Reciprocal(hn::MulAdd(hn::Set(d, 0.3275911f), size, one));
  Vector p = hn::Set(d, 1.061405429f);
  p = hn::MulAdd(p, t, hn::Set(d, -1.453152027f));
  p = hn::MulAdd(p, t, hn::Set(d, 1.421413741f));
  p = hn::MulAdd(p, t, hn::Set(d, -0.284496736f));
  p = hn::MulAdd(p, t, hn::Set(d, 0.254829592f));
  const Vector result = hn::NegMulAdd(p * t, Exp(hn::Neg(size * size)), one);
  return hn::CopySignToAbs(result, x);
}

}  // namespace duet::cpu_engine::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
