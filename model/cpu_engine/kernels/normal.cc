#include "model/cpu_engine/kernels/normal.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/cpu_engine/kernels/normal.cc"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Must follow foreach_target.h.
#include <hwy/highway.h>
// clang-format off: alphabetical order would put this first.
#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace duet::cpu_engine::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, 8>;

HWY_INLINE hn::Vec<Tag> Normals(const double* uniform) {
  const Tag d;
  hn::Vec<Tag> radius, angle;
  hn::LoadInterleaved2(d, uniform, radius, angle);
  radius = hn::Sqrt(hn::Set(d, -2.0) * hn::Log(d, radius));
  return radius * hn::Cos(d, hn::Set(d, 6.283185307179586) * angle);
}

void BoxMuller(ptrdiff_t count, const double* uniform, float* out) {
  const Tag d;
  constexpr size_t kMost = hn::MaxLanes(d);
  const ptrdiff_t lanes = static_cast<ptrdiff_t>(hn::Lanes(d));
  HWY_ALIGN double pairs[2 * kMost];
  HWY_ALIGN double normals[kMost];
  for (ptrdiff_t i = 0; i < count; i += lanes) {
    const ptrdiff_t size = count - i < lanes ? count - i : lanes;
    const double* from = uniform + 2 * i;
    if (size < lanes) {
      for (ptrdiff_t k = 0; k < 2 * lanes; ++k) pairs[k] = k < 2 * size ? from[k] : 0.5;
      from = pairs;
    }
    hn::Store(Normals(from), d, normals);
    for (ptrdiff_t k = 0; k < size; ++k) out[i + k] = static_cast<float>(normals[k]);
  }
}

}  // namespace duet::cpu_engine::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duet::cpu_engine::kernels {

HWY_EXPORT(BoxMuller);

void StandardNormals(std::ptrdiff_t count, const double* uniform, float* out) {
  HWY_DYNAMIC_DISPATCH(BoxMuller)(count, uniform, out);
}

}  // namespace duet::cpu_engine::kernels
#endif
