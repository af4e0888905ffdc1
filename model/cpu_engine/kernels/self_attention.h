#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_SELF_ATTENTION_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_SELF_ATTENTION_H_

#include <cstddef>

#include "model/cpu_engine/kernels/matrix.h"

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

inline constexpr std::ptrdiff_t SelfAttentionScratch(int frames, int size) {
  return std::ptrdiff_t{frames} * frames +
         std::ptrdiff_t{kPanel} * (std::ptrdiff_t{PanelCount(frames)} * size +
                                   std::ptrdiff_t{PanelCount(size)} * frames);
}

// out = softmax over the keys of (queries keys^T / sqrt(size) + distance), times values.
// Source: Vaswani et al. 2017; the learned bias by distance: Raffel et al. 2020.
void AttendToSelf(const SelfAttention& attention);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_SELF_ATTENTION_H_
