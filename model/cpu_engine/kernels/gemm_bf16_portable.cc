#include "model/cpu_engine/kernels/gemm_bf16_portable.h"

#include <cstddef>
#include <cstring>

#include "model/cpu_engine/kernels/gemm_bf16.h"

namespace duet::cpu_engine::kernels {
namespace {

float FromBf16(uint16_t value) {
  const uint32_t bits = uint32_t{value} << 16;
  float whole;
  std::memcpy(&whole, &bits, sizeof(whole));
  return whole;
}

// Index in the panels of the weight of an output and an input.
std::ptrdiff_t At(int output, int input, int pairs) {
  return ((std::ptrdiff_t{output / kPanel} * pairs + input / 2) * kPanel + output % kPanel) * 2 +
         input % 2;
}

}  // namespace

void GemmBf16Portable(const Rows& x, const uint16_t* panels, const float* bias, bool adds,
                      const Output& y) {
  const int pairs = Bf16Pairs(x.width);
  for (int row = 0; row < x.count; ++row) {
    const float* const from = x.values + row * x.stride;
    float* const to = y.values + row * y.stride;
    for (int n = 0; n < y.width; ++n) {
      float sum = adds ? to[n] : bias == nullptr ? 0 : bias[n];
      for (int k = 0; k < x.width; ++k) {
        sum += FromBf16(ToBf16(from[k])) * FromBf16(panels[At(n, k, pairs)]);
      }
      to[n] = sum;
    }
  }
}

void PackRowsBf16Portable(const Rows& inputs, uint16_t* panels) {
  const int pairs = Bf16Pairs(inputs.count);
  for (int n = 0; n < PanelCount(inputs.width) * kPanel; ++n) {
    for (int k = 0; k < 2 * pairs; ++k) {
      const bool is_there = n < inputs.width && k < inputs.count;
      panels[At(n, k, pairs)] = is_there ? ToBf16(inputs.values[k * inputs.stride + n]) : 0;
    }
  }
}

}  // namespace duet::cpu_engine::kernels
