#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_SELF_ATTENTION_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_SELF_ATTENTION_H_

#include <cstddef>

namespace duet::cpu_engine::kernels {

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

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_SELF_ATTENTION_H_
