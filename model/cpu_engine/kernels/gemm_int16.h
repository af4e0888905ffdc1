#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_INT16_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_INT16_H_

#include <cstdint>
#include <vector>

#include "model/cpu_engine/kernels/matrix.h"

namespace duet::cpu_engine::kernels {

// Products of integers of 16 bits with sums of 32: twice as fast as float32 where the processor
// multiplies and adds them in one instruction, and several times closer to it than bfloat16.
//
// Every row is a multiple of integers: of x in blocks of inputs, of W for all inputs. The factor is
// such that a row's norm becomes kInt16Norm, or its largest value 32,767. The sums then stay
// within 2^31 for any values (Cauchy-Schwarz), so they are exact, and a result is off by about
// 1e-5 of the product of the two norms.
//
// Values that are not finite, or whose squares are not, give sums that are not finite either.

// Rounding adds at most half the root of the number of values to a norm: below 46,341, the root of
// 2^31, for 460,000 values.
inline constexpr float kInt16Norm = 46000;

// Whether this processor does (AVX-512 VNNI). Otherwise the product is plain C++, and slow.
bool HasInt16();

// A matrix [outputs, inputs] as integers.
struct Int16Matrix {
  std::vector<int16_t> panels;  // [PanelCount(outputs), pairs of inputs, kPanel, 2]
  std::vector<float> units;     // of each output's row; padded to whole panels
};

// Rounds `count` values to multiples of the returned unit.
float RoundToInt16(const float* from, int count, int16_t* to);

// Rounds and packs a matrix [outputs, inputs], row-major.
Int16Matrix PackInt16(const float* weights, int outputs, int inputs);

// y = x W^T + bias. A null bias means none; it is padded to whole panels.
//
// A row's result does not depend on the other rows.
void GemmInt16(const Rows& x, const Int16Matrix& matrix, const float* bias, const Output& y);

// The same in plain C++, up to the rounding of the units, for tests.
void GemmInt16Portable(const Rows& x, const Int16Matrix& matrix, const float* bias,
                       const Output& y);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_INT16_H_
