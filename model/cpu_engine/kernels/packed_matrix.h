#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_PACKED_MATRIX_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_PACKED_MATRIX_H_

#include <cstddef>
#include <string>
#include <vector>

#include "model/cpu_engine/kernels/gemm.h"

namespace duet::cpu_engine::kernels {

// The type of the factors of products.
enum class Precision {
  kFloat32,
  kInt16  // half the memory and, where IsInt16Faster(), 1.2 to 2 times the speed
};

// The instruction set for which the kernels that run here were compiled, such as "AVX-512", "AVX2"
// or "NEON". Different ones add in different orders, so that results differ by rounding.
std::string InstructionSet();

// Packs a matrix [outputs, inputs], whose value of output n and input k is
// from[n output_stride + k input_stride], in the order in which a product reads it:
// [PanelCount(outputs), inputs, kPanel], with zeros after the last output.
void PackPanels(const float* from, std::ptrdiff_t output_stride, std::ptrdiff_t input_stride,
                int outputs, int inputs, float* panels);

// A layer's weights and bias in the layout of products.
//
// Threads: const methods are safe to call concurrently.
class PackedMatrix {
 public:
  PackedMatrix() = default;
  // Shapes: weights [outputs, inputs] row-major, bias [outputs] or empty for none.
  PackedMatrix(const std::vector<float>& weights, const std::vector<float>& bias, int outputs,
               int inputs, Precision precision);

  int outputs() const { return outputs_; }
  int inputs() const { return inputs_; }
  bool empty() const { return outputs_ == 0; }

  // y [rows, outputs] = x [rows, inputs] W^T + bias. Rows of x are x_stride values apart, those of
  // y y_stride. A row's result does not depend on the other rows.
  void Multiply(int rows, const float* x, std::ptrdiff_t x_stride, float* y,
                std::ptrdiff_t y_stride) const;
  void Multiply(int rows, const float* x, float* y) const {
    Multiply(rows, x, inputs_, y, outputs_);
  }

 private:
  int outputs_ = 0, inputs_ = 0;
  Precision precision_ = Precision::kFloat32;
  std::vector<float> panels_;
  Int16Matrix integers_;
  std::vector<float> bias_;  // empty, or padded with zeros to whole panels
};

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_PACKED_MATRIX_H_
