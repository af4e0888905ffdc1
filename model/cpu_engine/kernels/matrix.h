#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_MATRIX_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_MATRIX_H_

#include <cstddef>

namespace duet::cpu_engine::kernels {

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

// Number of rows of the next tile, of `left` remaining rows and at most `most`. Keeps tiles as even
// as possible, because a small tile costs as much as a large one.
inline constexpr int NextTile(int left, int most) {
  const int tiles = (left + most - 1) / most;
  return (left + tiles - 1) / tiles;
}

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_MATRIX_H_
