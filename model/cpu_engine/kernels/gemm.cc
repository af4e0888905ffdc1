#include "model/cpu_engine/kernels/gemm.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/cpu_engine/kernels/gemm.cc"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "model/cpu_engine/kernels/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace duet::cpu_engine::kernels::HWY_NAMESPACE {

// Vectors of sums that fit the registers besides the factors.
constexpr int kSums = HWY_TARGET <= HWY_AVX3 ? 24 : 12;
// Maximum rows of a tile, with two vectors of sums each.
constexpr int kRows = kSums / 2;

// Some inputs of some rows, times the weights of all columns. A value is a float, or a pair of
// integers of 16 bits.
template <typename Value>
struct Block {
  const Value* x;
  ptrdiff_t x_stride;
  const Value* panels;  // from the block's first value on
  ptrdiff_t panel;      // values from one panel to the next
  int size;             // values of a row
  const float* bias;    // null for none
  Output y;
  // Of integers:
  const float* x_units = nullptr;  // of each row
  const float* units = nullptr;    // of each column
  bool adds = false;               // to the sums of earlier blocks in y
};

// Products of float32.
struct Floats {
  using Value = float;
  using D = Tag;

  static HWY_INLINE Vector Begin(const Block<float>& block, int column) {
    return block.bias == nullptr ? hn::Zero(D()) : hn::LoadU(D(), block.bias + column);
  }
  static HWY_INLINE Vector Add(Vector sums, Vector x, Vector w) { return hn::MulAdd(x, w, sums); }

  // Turns sums of a vector of columns into results.
  struct End {
    HWY_INLINE End(const Block<float>&, int) {}
    HWY_INLINE Vector operator()(int, Vector sums, int, const float*) const { return sums; }
  };
};

using IntTag = hn::RebindToSigned<Tag>;
using Ints = hn::Vec<IntTag>;

// Products of pairs of integers of 16 bits, with sums of 32 bits.
struct Pairs {
  using Value = int32_t;
  using D = IntTag;

  static HWY_INLINE Ints Begin(const Block<int32_t>&, int) { return hn::Zero(D()); }
  static HWY_INLINE Ints Add(Ints sums, Ints x, Ints w) {
#if HWY_TARGET <= HWY_SSSE3  // x86
    const hn::Repartition<int16_t, D> halves;
    Ints unused = sums;
    sums = hn::ReorderWidenMulAccumulate(D(), hn::BitCast(halves, x), hn::BitCast(halves, w), sums,
                                         unused);
    // Without this, GCC 12 moves the sums to memory and back, which takes longer than the products.
    __asm__("" : "+v"(sums.raw));
    return sums;
#else
    const auto low = [](Ints v) { return hn::ShiftRight<16>(hn::ShiftLeft<16>(v)); };
    return sums + low(x) * low(w) + hn::ShiftRight<16>(x) * hn::ShiftRight<16>(w);
#endif
  }

  struct End {
    HWY_INLINE End(const Block<int32_t>& of, int column)
        : block(of),
          units(hn::LoadU(Tag(), of.units + column)),
          bias(of.bias == nullptr ? hn::Zero(Tag()) : hn::LoadU(Tag(), of.bias + column)) {}
    HWY_INLINE Vector operator()(int row, Ints sums, int valid, const float* y) const {
      const Vector unit = hn::Set(Tag(), block.x_units[row]) * units;
      return hn::MulAdd(hn::ConvertTo(Tag(), sums), unit, block.adds ? LoadFirst(valid, y) : bias);
    }
    const Block<int32_t>& block;
    Vector units, bias;
  };
};

#if HWY_TARGET <= HWY_AVX3
// The same in one instruction. GCC 12 moves the sums to memory and back around
// _mm512_dpwssd_epi32, which takes longer than the products.
struct FusedPairs : Pairs {
  static HWY_INLINE Ints Add(Ints sums, Ints x, Ints w) {
    __asm__("vpdpwssd %2, %1, %0" : "+v"(sums.raw) : "v"(x.raw), "v"(w.raw));
    return sums;
  }
};
#endif

// Computes kCount rows by kVectors vectors of columns from `column` on, in registers over the
// block. More than one are pairs that share a panel.
template <typename Kind, int kCount, int kVectors>
HWY_NOINLINE void Tile(const Block<typename Kind::Value>& block, int column) {
  constexpr int kSides = kVectors == 1 ? 1 : 2, kPairs = kVectors / kSides;
  const typename Kind::D d;
  const int lanes = static_cast<int>(Lanes()), step = kSides * lanes;
  const typename Kind::Value* weights[kPairs];
  hn::Vec<typename Kind::D> sums[kCount][kVectors];
  for (int p = 0; p < kPairs; ++p) {
    const int at = column + p * step;
    weights[p] = block.panels + at / kPanel * block.panel + at % kPanel;
    for (int side = 0; side < kSides; ++side) {
      const auto begin = Kind::Begin(block, at + side * lanes);
      for (int r = 0; r < kCount; ++r) sums[r][kSides * p + side] = begin;
    }
  }
  const typename Kind::Value* HWY_RESTRICT x = block.x;
  for (int k = 0; k < block.size; ++k) {
    hn::Vec<typename Kind::D> w[kVectors];
    for (int p = 0; p < kPairs; ++p) {
      for (int side = 0; side < kSides; ++side) {
        w[kSides * p + side] = hn::LoadU(d, weights[p] + side * lanes);
      }
      weights[p] += kPanel;
    }
    for (int r = 0; r < kCount; ++r) {
      const auto value = hn::Set(d, x[r * block.x_stride + k]);
      for (int v = 0; v < kVectors; ++v) sums[r][v] = Kind::Add(sums[r][v], value, w[v]);
    }
  }
  for (int v = 0; v < kVectors; ++v) {
    const int at = column + v * lanes, valid = block.y.width - at;
    if (valid <= 0) break;
    const typename Kind::End end(block, at);
    for (int r = 0; r < kCount; ++r) {
      float* const y = block.y.values + r * block.y.stride + at;
      StoreFirst(valid, end(r, sums[r][v], valid, y), y);
    }
  }
}

// Rows of the next tile, of `left` remaining rows: tiles as even as possible, because a small tile
// costs as much as a large one.
int NextTile(int left) {
  const int tiles = (left + kRows - 1) / kRows;
  return (left + tiles - 1) / tiles;
}

// Computes the columns up to `end` of kCount rows, as many at once as the registers hold.
template <typename Kind, int kCount>
HWY_INLINE void Strip(const Block<typename Kind::Value>& block, int column, int end) {
  constexpr int kPairs = kRows / kCount < 4 ? kRows / kCount : 4;
  const int lanes = static_cast<int>(Lanes()), step = 2 * lanes;
  for (; column + (kPairs - 1) * step < end; column += kPairs * step) {
    Tile<Kind, kCount, 2 * kPairs>(block, column);
  }
  for (; column + lanes < end; column += step) Tile<Kind, kCount, 2>(block, column);
  if (column < end) Tile<Kind, kCount, 1>(block, column);
}

template <typename Kind, int kCount = kRows>
void StripOf(int count, const Block<typename Kind::Value>& block, int column, int end) {
  if (count == kCount) {
    Strip<Kind, kCount>(block, column, end);
  } else if constexpr (kCount > 1) {
    StripOf<Kind, kCount - 1>(count, block, column, end);
  }
}

// Columns that are multiplied by all rows of a block before the next columns: their weights stay in
// the first-level cache.
constexpr int kColumnsAtOnce = 4 * kPanel;
// Rows of a block: their values stay in the second-level cache.
constexpr int kRowsAtOnce = 96;

void MultiplyFloats(const Rows& x, const float* panels, const float* bias, const Output& y) {
  for (int begin = 0; begin < x.count; begin += kRowsAtOnce) {
    const int end = HWY_MIN(begin + kRowsAtOnce, x.count);
    for (int column = 0; column < y.width; column += kColumnsAtOnce) {
      const int last = HWY_MIN(column + kColumnsAtOnce, y.width);
      for (int row = begin; row < end;) {
        const int count = NextTile(end - row);
        const Block<float> block{x.values + row * x.stride,
                                 x.stride,
                                 panels,
                                 ptrdiff_t{x.width} * kPanel,
                                 x.width,
                                 bias,
                                 {y.values + row * y.stride, y.stride, y.width}};
        StripOf<Floats>(count, block, column, last);
        row += count;
      }
    }
  }
}

// Pairs of inputs of a block of integers: the rounded rows of a tile stay in the first-level cache.
constexpr int kPairsAtOnce = 256;

// Rounds a row to multiples of the returned unit, with zeros after it up to whole vectors.
float Round(const float* from, int count, int32_t* pairs) {
  constexpr float kMost = 32767;
  // Below this norm a row counts as zeros: the inverse of its unit would not be finite.
  constexpr float kLeastNorm = 1e-30f;
  const Tag d;
  Vector squares = hn::Zero(d), largest = hn::Zero(d);
  for (int k = 0; k < count; k += Lanes()) {
    const Vector value = LoadFirst(count - k, from + k);
    squares = hn::MulAdd(value, value, squares);
    largest = hn::Max(largest, hn::Abs(value));
  }
  const float norm = std::sqrt(hn::GetLane(hn::SumOfLanes(d, squares)));
  const float most = hn::GetLane(hn::MaxOfLanes(d, largest));
  const float units =
      std::min(kInt16Norm / std::max(norm, kLeastNorm), kMost / std::max(most, kLeastNorm));
  const Vector by = hn::Set(d, units);
  const hn::Rebind<int16_t, Tag> halves;
  for (int k = 0; k < count; k += Lanes()) {
    const Ints integers = hn::NearestInt(LoadFirst(count - k, from + k) * by);
    hn::StoreU(hn::DemoteTo(halves, integers), halves, reinterpret_cast<int16_t*>(pairs) + k);
  }
  return 1 / units;
}

template <typename Kind>
void MultiplyInt16As(const Rows& x, const Int16Matrix& matrix, const float* bias, const Output& y) {
  alignas(64) int32_t rounded[kRows * kPairsAtOnce];
  float x_units[kRows];
  const int pairs = (x.width + 1) / 2;
  for (int row = 0; row < x.count;) {
    const int count = NextTile(x.count - row);
    for (int first = 0; first < pairs; first += kPairsAtOnce) {
      for (int r = 0; r < count; ++r) {
        x_units[r] =
            Round(x.values + (row + r) * x.stride + 2 * first,
                  HWY_MIN(2 * kPairsAtOnce, x.width - 2 * first), rounded + r * kPairsAtOnce);
      }
      const Block<int32_t> block{rounded,
                                 kPairsAtOnce,
                                 matrix.panels.data() + ptrdiff_t{first} * kPanel,
                                 ptrdiff_t{pairs} * kPanel,
                                 HWY_MIN(kPairsAtOnce, pairs - first),
                                 bias,
                                 {y.values + row * y.stride, y.stride, y.width},
                                 x_units,
                                 matrix.units.data(),
                                 first > 0};
      StripOf<Kind>(count, block, 0, y.width);
    }
    row += count;
  }
}

void MultiplyInt16(const Rows& x, const Int16Matrix& matrix, const float* bias, const Output& y) {
#if HWY_TARGET <= HWY_AVX3
  static const bool is_fused = __builtin_cpu_supports("avx512vnni");
  if (is_fused) return MultiplyInt16As<FusedPairs>(x, matrix, bias, y);
#endif
  MultiplyInt16As<Pairs>(x, matrix, bias, y);
}

}  // namespace duet::cpu_engine::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duet::cpu_engine::kernels {

bool IsInt16Faster() { return (hwy::SupportedTargets() & (HWY_SSE4 | HWY_AVX2 | HWY_AVX3)) != 0; }

HWY_EXPORT(MultiplyFloats);
HWY_EXPORT(MultiplyInt16);
HWY_EXPORT(Round);

void GemmF32(const Rows& x, const float* panels, const float* bias, const Output& y) {
  HWY_DYNAMIC_DISPATCH(MultiplyFloats)(x, panels, bias, y);
}

void GemmInt16(const Rows& x, const Int16Matrix& matrix, const float* bias, const Output& y) {
  HWY_DYNAMIC_DISPATCH(MultiplyInt16)(x, matrix, bias, y);
}

Int16Matrix PackInt16(const float* weights, int outputs, int inputs) {
  constexpr int kMostLanes = 16;
  const std::ptrdiff_t pairs = (inputs + 1) / 2, count = PanelCount(outputs);
  Int16Matrix matrix;
  matrix.panels.resize(static_cast<std::size_t>(count * pairs * kPanel));
  matrix.units.resize(static_cast<std::size_t>(count * kPanel));
  std::vector<int32_t> rounded(static_cast<std::size_t>(pairs + kMostLanes));
  for (std::ptrdiff_t n = 0; n < outputs; ++n) {
    matrix.units[static_cast<std::size_t>(n)] =
        HWY_DYNAMIC_DISPATCH(Round)(weights + n * inputs, inputs, rounded.data());
    int32_t* to = matrix.panels.data() + n / kPanel * pairs * kPanel + n % kPanel;
    for (std::ptrdiff_t k = 0; k < pairs; ++k, to += kPanel) {
      *to = rounded[static_cast<std::size_t>(k)];
    }
  }
  return matrix;
}

}  // namespace duet::cpu_engine::kernels
#endif
