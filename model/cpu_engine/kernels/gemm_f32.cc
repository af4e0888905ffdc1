#include "model/cpu_engine/kernels/gemm_f32.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/cpu_engine/kernels/gemm_f32.cc"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "model/cpu_engine/kernels/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace duet::cpu_engine::kernels::HWY_NAMESPACE {

// Vectors of sums that fit the registers besides the factors.
constexpr int kSums = HWY_TARGET <= HWY_AVX3 ? 24 : 12;
// Maximum rows of a tile, with two vectors of sums each.
constexpr int kRows = kSums / 2;

// A product, computed tile by tile.
struct Product {
  Rows x;
  const float* panels;
  const float* bias;
  Output y;
};

// Computes kCount rows by kVectors vectors of columns from `column` on, in registers over all
// inputs. More than one are pairs that share a panel.
template <int kCount, int kVectors>
HWY_INLINE void Tile(const Product& product, int row, int column) {
  constexpr int kSides = kVectors == 1 ? 1 : 2, kPairs = kVectors / kSides;
  const Tag d;
  const int lanes = static_cast<int>(Lanes()), step = kSides * lanes;
  const float* weights[kPairs];
  Vector sums[kCount][kVectors];
  for (int p = 0; p < kPairs; ++p) {
    const int at = column + p * step;
    weights[p] = product.panels + static_cast<ptrdiff_t>(at / kPanel) * product.x.width * kPanel +
                 at % kPanel;
    for (int side = 0; side < kSides; ++side) {
      const Vector begin =
          product.bias == nullptr ? hn::Zero(d) : hn::LoadU(d, product.bias + at + side * lanes);
      for (int r = 0; r < kCount; ++r) sums[r][kSides * p + side] = begin;
    }
  }
  const float* HWY_RESTRICT x = product.x.values + row * product.x.stride;
  for (int k = 0; k < product.x.width; ++k) {
    Vector w[kVectors];
    for (int p = 0; p < kPairs; ++p) {
      for (int side = 0; side < kSides; ++side) {
        w[kSides * p + side] = hn::LoadU(d, weights[p] + side * lanes);
      }
      weights[p] += kPanel;
    }
    for (int r = 0; r < kCount; ++r) {
      const Vector value = hn::Set(d, x[r * product.x.stride + k]);
      for (int v = 0; v < kVectors; ++v) sums[r][v] = hn::MulAdd(value, w[v], sums[r][v]);
    }
  }
  for (int r = 0; r < kCount; ++r) {
    float* y = product.y.values + (row + r) * product.y.stride + column;
    for (int v = 0; v < kVectors; ++v) {
      const int valid = product.y.width - column - v * lanes;
      if (valid > 0) StoreFirst(valid, sums[r][v], y + v * lanes);
    }
  }
}

// Computes all columns of `count` rows, as many at once as the registers hold.
template <int kCount>
HWY_INLINE void Strip(const Product& product, int row, int column, int end) {
  constexpr int kPairs = kRows / kCount < 4 ? kRows / kCount : 4;
  const int lanes = static_cast<int>(Lanes()), step = 2 * lanes;
  for (; column + (kPairs - 1) * step < end; column += kPairs * step) {
    Tile<kCount, 2 * kPairs>(product, row, column);
  }
  for (; column + lanes < end; column += step) Tile<kCount, 2>(product, row, column);
  if (column < end) Tile<kCount, 1>(product, row, column);
}

template <int kCount>
void StripOf(int count, const Product& product, int row, int column, int end) {
  if (count == kCount) {
    Strip<kCount>(product, row, column, end);
  } else if constexpr (kCount > 1) {
    StripOf<kCount - 1>(count, product, row, column, end);
  }
}

// Columns that are multiplied by all rows of a block before the next columns: their weights stay in
// the first-level cache.
constexpr int kColumnsAtOnce = 4 * kPanel;
// Rows of a block: their values stay in the second-level cache.
constexpr int kRowsAtOnce = 96;

void Gemm(const Rows& x, const float* panels, const float* bias, const Output& y) {
  const Product product{x, panels, bias, y};
  const int rows = product.x.count, columns = product.y.width;
  for (int begin = 0; begin < rows; begin += kRowsAtOnce) {
    const int end = HWY_MIN(begin + kRowsAtOnce, rows);
    for (int column = 0; column < columns; column += kColumnsAtOnce) {
      const int last = HWY_MIN(column + kColumnsAtOnce, columns);
      for (int row = begin; row < end;) {
        const int count = NextTile(end - row, kRows);
        StripOf<kRows>(count, product, row, column, last);
        row += count;
      }
    }
  }
}

}  // namespace duet::cpu_engine::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duet::cpu_engine::kernels {

HWY_EXPORT(Gemm);

void GemmF32(const Rows& x, const float* panels, const float* bias, const Output& y) {
  HWY_DYNAMIC_DISPATCH(Gemm)(x, panels, bias, y);
}

}  // namespace duet::cpu_engine::kernels
#endif
