#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_BF16_ROWS_INL_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_BF16_ROWS_INL_H_

// Shared by the products of bfloat16 with AVX-512 BF16. Only for x86-64.

#include <immintrin.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "model/cpu_engine/kernels/gemm_bf16.h"
#include "model/cpu_engine/kernels/matrix.h"

// Highway 1.0.3 has no such product, so this uses the intrinsic.
#define DUET_BF16 __attribute__((target("avx512f,avx512bw,avx512vl,avx512dq,avx512bf16")))

namespace duet::cpu_engine::kernels {

inline constexpr int kLanes = 16;

DUET_BF16 inline __mmask16 FirstOf(int valid) {
  const int clamped = std::clamp(valid, 0, kLanes);
  return static_cast<__mmask16>((1u << clamped) - 1);
}

// Rounds the rows to `out`, kStride values apart, with a zero after an odd number of values.
template <int kStride>
DUET_BF16 inline void RoundRows(const Rows& x, uint16_t* out) {
  for (int r = 0; r < x.count; ++r) {
    const float* from = x.values + r * x.stride;
    uint16_t* to = out + std::ptrdiff_t{r} * kStride;
    int k = 0;
    for (; k + kLanes <= x.width; k += kLanes) {
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + k),
                          reinterpret_cast<__m256i>(_mm512_cvtneps_pbh(_mm512_loadu_ps(from + k))));
    }
    for (; k < x.width; ++k) to[k] = ToBf16(from[k]);
    if (x.width % 2 != 0) to[x.width] = 0;
  }
}

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_BF16_ROWS_INL_H_
