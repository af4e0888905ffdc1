#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_AMX_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_AMX_H_

#include <cstdint>

#include "model/cpu_engine/kernels/matrix.h"

namespace duet::cpu_engine::kernels {

// Whether this process may multiply bfloat16 in tiles (AMX-BF16): the processor supports it, and
// the operating system saves the tiles of every thread. The first call requests that.
bool HasAmx();

// GemmBf16 and AddGemmBf16 of gemm_bf16.h in tiles of 16 rows by 16 columns. Require HasAmx().
//
// A row's result does not depend on the other rows: a tile sums each row separately, in an order
// that does not depend on the number of rows.
void GemmBf16Amx(const Rows& x, const uint16_t* panels, const float* bias, bool adds,
                 const Output& y);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_AMX_H_
