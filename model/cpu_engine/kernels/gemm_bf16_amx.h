#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_AMX_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_AMX_H_

#include <cstdint>

#include "model/cpu_engine/kernels/matrix.h"

namespace duet::cpu_engine::kernels {

// Whether this process may multiply bfloat16 in tiles (AMX-BF16): the processor does, and the
// kernel, which is asked for it the first time, keeps the tiles of every thread.
bool HasAmx();

// What gemm_bf16.h promises of GemmBf16 and AddGemmBf16, in tiles of 16 rows by 16 columns. Only
// where HasAmx().
//
// A row's result does not depend on the other rows: a tile sums each of its rows for itself, in the
// same order however many there are.
void GemmBf16Amx(const Rows& x, const uint16_t* panels, const float* bias, bool adds,
                 const Output& y);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_AMX_H_
