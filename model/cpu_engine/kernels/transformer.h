#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_TRANSFORMER_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_TRANSFORMER_H_

#include <cstddef>

// The kernels of the sampling generator.
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

// One head of one window.
struct SelfAttention {
  int frames, size;
  const float *queries, *keys, *values;  // [frames, size], rows in_stride values apart
  std::ptrdiff_t in_stride;
  const float* distance;  // [2 frames - 1]: of key frame - query frame, + frames - 1
  float* out;             // [frames, size], rows out_stride apart
  std::ptrdiff_t out_stride;
  float* scratch;  // SelfAttentionScratch(frames, size) values
};

// Queries of a row of the scratch: whole vectors of any instruction set.
inline constexpr std::ptrdiff_t SelfAttentionStride(int frames) { return (frames + 15) / 16 * 16; }
inline constexpr std::ptrdiff_t SelfAttentionScratch(int frames, int size) {
  return SelfAttentionStride(frames) * (size + frames + 1) + frames;
}

// out = softmax over the keys of (queries keys^T / sqrt(size) + distance), times values.
// Source: Vaswani et al. 2017; the learned bias by distance: Raffel et al. 2020.
void AttendToSelf(const SelfAttention& attention);

// Computes standard normal numbers from pairs of uniform ones in (0, 1). They equal those of
// base::Random::StandardNormal to one or two units in the last place. Shapes: uniform [count, 2],
// out [count]. Source: Box, Muller 1958.
void StandardNormals(std::ptrdiff_t count, const double* uniform, float* out);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_TRANSFORMER_H_
