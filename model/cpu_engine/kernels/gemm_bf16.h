#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_H_

#include <cstdint>

#include "model/cpu_engine/kernels/matrix.h"

namespace duet::cpu_engine::kernels {

// Whether this processor multiplies bfloat16 (AVX-512 BF16). Without, products of the same rounding
// are slower than those of float32.
bool HasBf16();

// What products in bfloat16 are made by: in plain C++, by AVX-512 BF16, in tiles (AMX). The best is
// the last of these that there is here: HasBf16(), HasAmx().
enum class Bf16Product { kBest, kPortable, kAvx512, kAmx };
// From here on, for tests and benchmarks. Not while another thread multiplies; not what is not
// here.
void ChooseBf16Product(Bf16Product product);

// `value` rounded to the nearest bfloat16, ties to even. Finite values only.
uint16_t ToBf16(float value);

// Inputs of a row that are multiplied as one: pairs.
inline constexpr int Bf16Pairs(int inputs) { return (inputs + 1) / 2; }

// y = x W^T + bias, or without one where it is null: factors in bfloat16, sums in float32. `panels`
// are [PanelCount(outputs), Bf16Pairs(inputs), kPanel, 2], the bias is padded to whole panels. x is
// rounded on the way in. Slow without HasBf16().
//
// A row's result does not depend on the other rows.
void GemmBf16(const Rows& x, const uint16_t* panels, const float* bias, const Output& y);
// y += x W^T.
void AddGemmBf16(const Rows& x, const uint16_t* panels, const Output& y);

// Lays a matrix's transpose out as panels: the rows of `inputs` are what the product sums over.
// Shape: panels [PanelCount(inputs.width), Bf16Pairs(inputs.count), kPanel, 2].
void PackRowsBf16(const Rows& inputs, uint16_t* panels);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_H_
