#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_H_

#include <cstdint>

#include "model/cpu_engine/kernels/matrix.h"

namespace duet::cpu_engine::kernels {

// Whether this processor multiplies bfloat16 (AVX-512 BF16). Otherwise products with the same
// rounding are slower than products of float32.
bool HasBf16();
// Whether its products of bfloat16 are also faster than those of float32. On Intel's processors
// without AMX they take 1.6 to 1.9 times as long (kernel_benchmark on Emerald Rapids).
bool IsBf16Faster();

// Implementations of products in bfloat16: plain C++, AVX-512 BF16, AMX tiles. The default is the
// last one that this processor supports: HasBf16(), HasAmx().
enum class Bf16Product { kBest, kPortable, kAvx512, kAmx };
// Selects the implementation of later products, for tests and benchmarks. Requires that the
// processor supports it and that no other thread multiplies meanwhile.
void ChooseBf16Product(Bf16Product product);

// `value` rounded to the nearest bfloat16, ties to even. Finite values only.
uint16_t ToBf16(float value);

// Number of pairs of inputs in a row. A pair is multiplied as one.
inline constexpr int Bf16Pairs(int inputs) { return (inputs + 1) / 2; }

// y = x W^T + bias, with factors in bfloat16 and sums in float32. A null bias means none. `panels`
// are [PanelCount(outputs), Bf16Pairs(inputs), kPanel, 2]; the bias is padded to whole panels.
// Rounds x to bfloat16. Slow without HasBf16().
//
// A row's result does not depend on the other rows.
void GemmBf16(const Rows& x, const uint16_t* panels, const float* bias, const Output& y);
// y += x W^T.
void AddGemmBf16(const Rows& x, const uint16_t* panels, const Output& y);

// Packs the transpose of a matrix into panels: the product sums over the rows of `inputs`.
// Shape: panels [PanelCount(inputs.width), Bf16Pairs(inputs.count), kPanel, 2].
void PackRowsBf16(const Rows& inputs, uint16_t* panels);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_BF16_H_
