#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_F32_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_F32_H_

#include "model/cpu_engine/kernels/matrix.h"

namespace duet::cpu_engine::kernels {

// y = x W^T + bias in float32. A null bias means none. `panels` are W's rows in the layout of
// PackPanels; the bias is padded to whole panels.
//
// A row's sums are added in the order of its inputs whatever the number of rows, so its result does
// not depend on the other rows.
void GemmF32(const Rows& x, const float* panels, const float* bias, const Output& y);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_F32_H_
