#include "model/cpu_engine/kernels/packed_matrix.h"

#include <hwy/targets.h>

#include <algorithm>

namespace duet::cpu_engine::kernels {
namespace {

std::size_t Size(std::ptrdiff_t count) { return static_cast<std::size_t>(count); }

}  // namespace

std::string InstructionSet() {
  const int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
  const std::string name = hwy::TargetName(usable & -usable);  // the lowest bit is the best
  // AVX3, AVX3_ZEN4 and others: all have vectors of 512 bits.
  return name.rfind("AVX3", 0) == 0 ? "AVX-512" : name;
}

void PackPanels(const float* from, std::ptrdiff_t output_stride, std::ptrdiff_t input_stride,
                int outputs, int inputs, float* panels) {
  for (int first = 0; first < outputs; first += kPanel) {
    const int count = std::min(kPanel, outputs - first);
    const float* const columns = from + first * output_stride;
    if (count < kPanel) std::fill_n(panels, std::ptrdiff_t{inputs} * kPanel, 0.0f);
    if (output_stride == 1) {
      for (int k = 0; k < inputs; ++k) {
        std::copy_n(columns + k * input_stride, count, panels + std::ptrdiff_t{k} * kPanel);
      }
    } else {
      for (int c = 0; c < count; ++c) {
        const float* column = columns + c * output_stride;
        float* to = panels + c;
        for (int k = 0; k < inputs; ++k, column += input_stride, to += kPanel) *to = *column;
      }
    }
    panels += std::ptrdiff_t{inputs} * kPanel;
  }
}

PackedMatrix::PackedMatrix(const std::vector<float>& weights, const std::vector<float>& bias,
                           int outputs, int inputs, Precision precision)
    : outputs_(outputs), inputs_(inputs), precision_(precision), bias_(bias) {
  if (!bias_.empty()) bias_.resize(Size(std::ptrdiff_t{PanelCount(outputs)} * kPanel));
  if (precision == Precision::kInt16) {
    integers_ = PackInt16(weights.data(), outputs, inputs);
    return;
  }
  panels_.resize(Size(std::ptrdiff_t{PanelCount(outputs)} * inputs * kPanel));
  PackPanels(weights.data(), inputs, 1, outputs, inputs, panels_.data());
}

void PackedMatrix::Multiply(int rows, const float* x, std::ptrdiff_t x_stride, float* y,
                            std::ptrdiff_t y_stride) const {
  const Rows in{x, x_stride, rows, inputs_};
  const Output out{y, y_stride, outputs_};
  const float* bias = bias_.empty() ? nullptr : bias_.data();
  if (precision_ == Precision::kInt16) {
    GemmInt16(in, integers_, bias, out);
  } else {
    GemmF32(in, panels_.data(), bias, out);
  }
}

}  // namespace duet::cpu_engine::kernels
