// Included once for each instruction set, by way of foreach_target.h.
#if defined(DUET_MODEL_CPU_ENGINE_KERNELS_VECTOR_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DUET_MODEL_CPU_ENGINE_KERNELS_VECTOR_MATH_INL_H_
#undef DUET_MODEL_CPU_ENGINE_KERNELS_VECTOR_MATH_INL_H_
#else
#define DUET_MODEL_CPU_ENGINE_KERNELS_VECTOR_MATH_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duet::cpu_engine::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, 16>;
using Vector = hn::Vec<Tag>;

inline int Lanes() { return static_cast<int>(hn::Lanes(Tag())); }

// Whether a masked load or store touches nothing but what the mask names: before AVX2 Highway's
// reads a whole vector, and wants it aligned.
constexpr bool kMasksMemory = HWY_TARGET <= HWY_AVX2;

// The first `valid` values, zeros after them; all of a vector when there are as many.
HWY_INLINE Vector LoadFirst(int valid, const float* from) {
  const Tag d;
  if (valid >= Lanes()) return hn::LoadU(d, from);
  if constexpr (kMasksMemory) {
    return hn::MaskedLoad(hn::FirstN(d, static_cast<size_t>(valid)), d, from);
  } else {
    HWY_ALIGN float whole[hn::MaxLanes(d)] = {};
    for (int i = 0; i < valid; ++i) whole[i] = from[i];
    return hn::Load(d, whole);
  }
}

HWY_INLINE void StoreFirst(int valid, Vector v, float* to) {
  const Tag d;
  if (valid >= Lanes()) return hn::StoreU(v, d, to);
  if constexpr (kMasksMemory) {
    hn::BlendedStore(v, hn::FirstN(d, static_cast<size_t>(valid)), d, to);
  } else {
    HWY_ALIGN float whole[hn::MaxLanes(d)];
    hn::Store(v, d, whole);
    for (int i = 0; i < valid; ++i) to[i] = whole[i];
  }
}

// 1 / x, to the last digit or two. x is finite and neither 0 nor very small.
HWY_INLINE Vector Reciprocal(Vector x) {
  const Tag d;
  const Vector guess = hn::ApproximateReciprocal(x);
  const Vector two = hn::Set(d, 2.0f);
  const Vector better = guess * hn::NegMulAdd(guess, x, two);
  // Eleven bits at first where vectors are narrow: once more.
  return HWY_TARGET <= HWY_AVX3 ? better : better * hn::NegMulAdd(better, x, two);
}

// e^x, relative error below 2e-7; x is taken as within [-87, 88].
// Source: Cody, Waite 1980 (the reduction), a polynomial of degree 6.
HWY_INLINE Vector Exp(Vector x) {
  const Tag d;
  const hn::RebindToSigned<Tag> di;
  x = hn::Min(hn::Max(x, hn::Set(d, -87.0f)), hn::Set(d, 88.0f));
  const Vector n = hn::Round(x * hn::Set(d, 1.44269504088896341f));
  Vector r = hn::NegMulAdd(n, hn::Set(d, 0.693359375f), x);
  r = hn::NegMulAdd(n, hn::Set(d, -2.12194440e-4f), r);
  Vector p = hn::Set(d, 1.3981999507e-3f);
  p = hn::MulAdd(p, r, hn::Set(d, 8.3334519073e-3f));
  p = hn::MulAdd(p, r, hn::Set(d, 4.1665795894e-2f));
  p = hn::MulAdd(p, r, hn::Set(d, 1.6666665459e-1f));
  p = hn::MulAdd(p, r, hn::Set(d, 5.0000001201e-1f));
  p = hn::MulAdd(p * r, r, r) + hn::Set(d, 1.0f);
  const auto exponent = hn::ShiftLeft<23>(hn::ConvertTo(di, n));
  return hn::BitCast(d, hn::BitCast(di, p) + exponent);
}

HWY_INLINE Vector Sigmoid(Vector x) {
  const Vector one = hn::Set(Tag(), 1.0f);
  return Reciprocal(one + Exp(hn::Neg(x)));
}

HWY_INLINE Vector Tanh(Vector x) {
  const Tag d;
  const Vector one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
  // Beyond 10 it is 1 in float; the reciprocal's argument stays small.
  const Vector bounded = hn::Min(hn::Max(x, hn::Set(d, -10.0f)), hn::Set(d, 10.0f));
  return hn::NegMulAdd(two, Reciprocal(Exp(two * bounded) + one), one);
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

}  // namespace HWY_NAMESPACE
}  // namespace duet::cpu_engine::kernels
HWY_AFTER_NAMESPACE();

#endif
