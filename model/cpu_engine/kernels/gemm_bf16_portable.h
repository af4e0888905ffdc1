#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_PORTABLE_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_PORTABLE_H_

#include <cstdint>

#include "model/cpu_engine/kernels/matrix.h"

namespace duet::cpu_engine::kernels {

// The functions of gemm_bf16.h in plain C++, for processors that do not multiply bfloat16. Slow,
// with the same rounding.
void GemmBf16Portable(const Rows& x, const uint16_t* panels, const float* bias, bool adds,
                      const Output& y);
void PackRowsBf16Portable(const Rows& inputs, uint16_t* panels);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_PORTABLE_H_
