#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_ROWWISE_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_ROWWISE_H_

#include <cstddef>

namespace duet::cpu_engine::kernels {

// x Phi(x), in place. Source: Hendrycks, Gimpel 2016 (GELU, the exact form).
void Gelu(std::ptrdiff_t count, float* values);

// x sigmoid(x), in place.
void Silu(std::ptrdiff_t count, float* values);

// out = (x - mean) / deviation * (scale + scale_offset) + shift for a row of `width` values.
// Source: Ba et al. 2016; LibTorch's epsilon of 1e-5.
struct NormRow {
  int width;
  const float* x;
  const float* scale;
  float scale_offset;
  const float* shift;
  float* out;
};
void LayerNorm(const NormRow& row);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_ROWWISE_H_
