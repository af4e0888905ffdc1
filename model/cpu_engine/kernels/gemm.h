#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace duet::cpu_engine::kernels {

// Products y = x W^T + bias of a layer's inputs and weights. A null bias means none.
//
// W is in panels of kPanel outputs, and its bias is padded to whole panels. A row's sums are added
// in the order of its inputs whatever the number of rows, so its result does not depend on the
// other rows.

// Columns of a packed matrix that a product computes together: two of the widest vectors.
inline constexpr int kPanel = 32;
inline constexpr int PanelCount(int outputs) { return (outputs + kPanel - 1) / kPanel; }

// `count` rows of `width` values, `stride` values apart.
struct Rows {
  const float* values;
  std::ptrdiff_t stride;
  int count;
  int width;
};

// The destination of a product's rows: `width` values each, `stride` values apart.
struct Output {
  float* values;
  std::ptrdiff_t stride;
  int width;
};

// The product in float32. `panels` are W's rows in the layout of PackPanels.
void GemmF32(const Rows& x, const float* panels, const float* bias, const Output& y);

// Whether products of integers are faster than those of float32: on x86 processors with SSE4 or
// more.
bool IsInt16Faster();

// A matrix [outputs, inputs] whose rows are multiples of integers of 16 bits.
struct Int16Matrix {
  std::vector<int32_t> panels;  // [PanelCount(outputs), pairs of inputs, kPanel]
  std::vector<float> units;     // of each output's row; padded to whole panels
};

// A row becomes multiples of a unit such that its norm is kInt16Norm, or its largest value 32,767.
// Rounding adds at most half the root of the number of values to a norm: below 46,341, the root of
// 2^31, for 460,000 values.
inline constexpr float kInt16Norm = 46000;

// Rounds and packs a matrix [outputs, inputs], row-major.
Int16Matrix PackInt16(const float* weights, int outputs, int inputs);

// The product of integers of 16 bits with sums of 32. The rows of x are rounded like those of W, in
// blocks of inputs. Because of kInt16Norm, sums stay within 2^31 for any values (Cauchy-Schwarz),
// so they are exact, and a result is off by about 1e-5 of the product of the two norms. Values that
// are not finite, or whose squares are not, give results that are not finite either.
void GemmInt16(const Rows& x, const Int16Matrix& matrix, const float* bias, const Output& y);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_GEMM_H_
