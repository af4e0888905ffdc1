#include "model/cpu_engine/kernels/self_attention.h"

#include <cmath>

#include "model/cpu_engine/kernels/gemm_f32.h"
#include "model/cpu_engine/kernels/packed_matrix.h"
#include "model/cpu_engine/kernels/rowwise.h"

namespace duet::cpu_engine::kernels {

void AttendToSelf(const SelfAttention& in) {
  const std::ptrdiff_t frames = in.frames;
  float* const scores = in.scratch;
  float* const keys = scores + frames * frames;
  float* const values = keys + std::ptrdiff_t{PanelCount(in.frames)} * in.size * kPanel;
  PackPanels(in.keys, in.in_stride, 1, in.frames, in.size, keys);
  GemmF32({in.queries, in.in_stride, in.frames, in.size}, keys, nullptr,
          {scores, frames, in.frames});
  const float factor = 1 / std::sqrt(static_cast<float>(in.size));
  for (std::ptrdiff_t i = 0; i < frames; ++i) {
    BiasedSoftmax(in.frames, factor, in.distance + frames - 1 - i, scores + i * frames);
  }
  PackPanels(in.values, 1, in.in_stride, in.size, in.frames, values);
  GemmF32({scores, frames, in.frames, in.frames}, values, nullptr,
          {in.out, in.out_stride, in.size});
}

}  // namespace duet::cpu_engine::kernels
