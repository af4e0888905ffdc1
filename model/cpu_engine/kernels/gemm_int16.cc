#include "model/cpu_engine/kernels/gemm_int16.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace duet::cpu_engine::kernels {
namespace {

constexpr float kMost = std::numeric_limits<int16_t>::max();
// Below this norm a row counts as zeros: the inverse of its unit would not be finite.
constexpr float kLeastNorm = 1e-30f;

// Pairs of inputs of a block of x: the rounded rows of a tile stay in the first-level cache.
constexpr int kPairsAtOnce = 256;
constexpr int kLanes = 16;

int Pairs(int inputs) { return (inputs + 1) / 2; }

// The multiples of a value of 1 for a row with this norm and largest value.
float UnitsOf(float squares, float largest) {
  const float norm = std::max(std::sqrt(squares), kLeastNorm);
  return std::min(kInt16Norm / norm, kMost / std::max(largest, kLeastNorm));
}

}  // namespace

float RoundToInt16(const float* from, int count, int16_t* to) {
  float squares = 0, largest = 0;
  for (int k = 0; k < count; ++k) {
    squares += from[k] * from[k];
    largest = std::max(largest, std::abs(from[k]));
  }
  const float units = UnitsOf(squares, largest);
  for (int k = 0; k < count; ++k) {
    const float value = std::nearbyint(from[k] * units);
    // Values that are not finite have no integer; the unit is not finite then.
    to[k] = std::abs(value) <= kMost ? static_cast<int16_t>(value) : int16_t{0};
  }
  return 1 / units;
}

void GemmInt16Portable(const Rows& x, const Int16Matrix& matrix, const float* bias,
                       const Output& y) {
  const int pairs = Pairs(x.width);
  std::vector<int16_t> rounded(2 * static_cast<std::size_t>(kPairsAtOnce));
  for (int r = 0; r < x.count; ++r) {
    float* const out = y.values + r * y.stride;
    for (int n = 0; n < y.width; ++n) out[n] = bias == nullptr ? 0 : bias[n];
    for (int first = 0; first < x.width; first += 2 * kPairsAtOnce) {
      const int count = std::min(2 * kPairsAtOnce, x.width - first);
      const float unit = RoundToInt16(x.values + r * x.stride + first, count, rounded.data());
      for (int n = 0; n < y.width; ++n) {
        const int16_t* const panel =
            matrix.panels.data() +
            ((std::ptrdiff_t{n / kPanel} * pairs + first / 2) * kPanel + n % kPanel) * 2;
        int32_t sum = 0;
        for (int k = 0; k < count; ++k) {
          sum += int32_t{rounded[static_cast<std::size_t>(k)]} *
                 panel[std::ptrdiff_t{k / 2} * kPanel * 2 + k % 2];
        }
        out[n] += static_cast<float>(sum) * (unit * matrix.units[static_cast<std::size_t>(n)]);
      }
    }
  }
}

#if defined(__x86_64__)

#define DUET_VNNI __attribute__((target("avx512f,avx512bw,avx512vl,avx512dq,avx512vnni")))

namespace {

constexpr __mmask16 kAll = 0xffff;  // GCC 12 reports the forms without a mask as uninitialised
// Vectors of sums that fit the registers besides the factors, and rows of two such vectors.
constexpr int kSums = 24, kRows = kSums / 2;

DUET_VNNI inline __mmask16 FirstOf(int valid) {
  const int clamped = std::clamp(valid, 0, kLanes);
  return static_cast<__mmask16>((1u << clamped) - 1);
}

// A block of inputs of kRows rows at most, computed tile by tile.
struct Block {
  const int16_t* x;       // [kRows, 2 kPairsAtOnce], rounded
  const float* x_units;   // [kRows]
  const int16_t* panels;  // from the block's first pair on
  std::ptrdiff_t panel;   // values from one panel to the next
  const float* units;     // of the panels' columns
  int pairs;
  const float* bias;  // null without
  bool adds;          // to the sums of earlier blocks in y
  Output y;           // from the tile's first row on
};

// The lanes of `v` that are half, a quarter, ... of the vector away.
DUET_VNNI inline __m512 HalfAway(__m512 v) { return _mm512_maskz_shuffle_f32x4(kAll, v, v, 0x4e); }
DUET_VNNI inline __m512 FourAway(__m512 v) { return _mm512_maskz_shuffle_f32x4(kAll, v, v, 0xb1); }
DUET_VNNI inline __m512 TwoAway(__m512 v) { return _mm512_maskz_permute_ps(kAll, v, 0x4e); }
DUET_VNNI inline __m512 OneAway(__m512 v) { return _mm512_maskz_permute_ps(kAll, v, 0xb1); }

DUET_VNNI inline float SumOfLanes(__m512 v) {
  v = v + HalfAway(v);
  v = v + FourAway(v);
  v = v + TwoAway(v);
  return _mm512_cvtss_f32(v + OneAway(v));
}

DUET_VNNI inline float LargestOfLanes(__m512 v) {
  v = _mm512_maskz_max_ps(kAll, v, HalfAway(v));
  v = _mm512_maskz_max_ps(kAll, v, FourAway(v));
  v = _mm512_maskz_max_ps(kAll, v, TwoAway(v));
  return _mm512_cvtss_f32(_mm512_maskz_max_ps(kAll, v, OneAway(v)));
}

// The first `valid` values, at most kLanes, then zeros.
DUET_VNNI inline __m512 LoadFirst(int valid, const float* from) {
  return valid >= kLanes ? _mm512_loadu_ps(from) : _mm512_maskz_loadu_ps(FirstOf(valid), from);
}

// Rounds a row as RoundToInt16 does, with zeros after it up to a multiple of kLanes.
DUET_VNNI inline float RoundRow(const float* from, int count, int16_t* to) {
  __m512 squares = _mm512_setzero_ps(), largest = _mm512_setzero_ps();
  for (int k = 0; k < count; k += kLanes) {
    const __m512 value = LoadFirst(count - k, from + k);
    squares = _mm512_fmadd_ps(value, value, squares);
    largest = _mm512_maskz_max_ps(kAll, largest, _mm512_abs_ps(value));
  }
  const float units = UnitsOf(SumOfLanes(squares), LargestOfLanes(largest));
  const __m512 by = _mm512_set1_ps(units);
  for (int k = 0; k < count; k += kLanes) {
    const __m512 value = LoadFirst(count - k, from + k) * by;
    const __m512i integers = _mm512_maskz_cvtps_epi32(kAll, value);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + k),
                        _mm512_maskz_cvtsepi32_epi16(kAll, integers));
  }
  return 1 / units;
}

// sums + the products of two pairs in every lane. GCC 12 moves the sums to memory and back around
// _mm512_dpwssd_epi32, which takes longer than the products.
DUET_VNNI inline __m512i AddProducts(__m512i sums, __m512i x, __m512i w) {
  __asm__("vpdpwssd %2, %1, %0" : "+v"(sums) : "v"(x), "v"(w));
  return sums;
}

// Computes kCount rows by kVectors vectors of columns from column `column` on, in registers over
// the block.
template <int kCount, int kVectors>
DUET_VNNI __attribute__((noinline)) void Tile(const Block& block, int column) {
  const int16_t* weights = block.panels + column / kPanel * block.panel;
  __m512i sums[kCount][kVectors];
  for (int r = 0; r < kCount; ++r) {
    for (int v = 0; v < kVectors; ++v) sums[r][v] = _mm512_setzero_si512();
  }
  for (int pair = 0; pair < block.pairs; ++pair, weights += 2 * kPanel) {
    __m512i w[kVectors];
    for (int v = 0; v < kVectors; ++v) {
      w[v] = _mm512_loadu_si512(weights + v / 2 * block.panel + v % 2 * kPanel);
    }
    for (int r = 0; r < kCount; ++r) {
      int both;
      std::memcpy(&both, block.x + r * 2 * kPairsAtOnce + 2 * pair, sizeof(both));
      const __m512i value = _mm512_set1_epi32(both);
      for (int v = 0; v < kVectors; ++v) {
        sums[r][v] = AddProducts(sums[r][v], value, w[v]);
      }
    }
  }
  __m512 units[kVectors], bias[kVectors];
  for (int v = 0; v < kVectors; ++v) {
    const int at = column + v * kLanes;
    units[v] = _mm512_loadu_ps(block.units + at);
    bias[v] = block.bias == nullptr ? _mm512_setzero_ps() : _mm512_loadu_ps(block.bias + at);
  }
  for (int r = 0; r < kCount; ++r) {
    const __m512 unit = _mm512_set1_ps(block.x_units[r]);
    float* const y = block.y.values + r * block.y.stride + column;
    for (int v = 0; v < kVectors; ++v) {
      const __mmask16 valid = FirstOf(block.y.width - column - v * kLanes);
      const __m512 begin = block.adds ? _mm512_maskz_loadu_ps(valid, y + v * kLanes) : bias[v];
      const __m512 sum = _mm512_maskz_cvtepi32_ps(kAll, sums[r][v]);
      _mm512_mask_storeu_ps(y + v * kLanes, valid, _mm512_fmadd_ps(sum, unit * units[v], begin));
    }
  }
}

// Computes all columns of kCount rows, as many at once as the registers hold.
template <int kCount>
DUET_VNNI inline void Strip(const Block& block) {
  constexpr int kPanels = kRows / kCount < 4 ? kRows / kCount : 4;
  int column = 0;
  for (; column + (kPanels - 1) * kPanel < block.y.width; column += kPanels * kPanel) {
    Tile<kCount, 2 * kPanels>(block, column);
  }
  for (; column + kLanes < block.y.width; column += kPanel) Tile<kCount, 2>(block, column);
  if (column < block.y.width) Tile<kCount, 1>(block, column);
}

template <int kCount>
DUET_VNNI void StripOf(int count, const Block& block) {
  if (count == kCount) {
    Strip<kCount>(block);
  } else if constexpr (kCount > 1) {
    StripOf<kCount - 1>(count, block);
  }
}

DUET_VNNI void Gemm(const Rows& x, const Int16Matrix& matrix, const float* bias, const Output& y) {
  alignas(64) int16_t rounded[kRows * 2 * kPairsAtOnce];
  float units[kRows];
  const int pairs = Pairs(x.width);
  for (int row = 0; row < x.count;) {
    const int count = NextTile(x.count - row, kRows);
    for (int first = 0; first < pairs; first += kPairsAtOnce) {
      const int size = std::min(kPairsAtOnce, pairs - first);
      for (int r = 0; r < count; ++r) {
        units[r] = RoundRow(x.values + (row + r) * x.stride + 2 * first,
                            std::min(2 * size, x.width - 2 * first),
                            rounded + std::ptrdiff_t{r} * 2 * kPairsAtOnce);
      }
      StripOf<kRows>(count, {rounded,
                             units,
                             matrix.panels.data() + std::ptrdiff_t{first} * 2 * kPanel,
                             std::ptrdiff_t{pairs} * 2 * kPanel,
                             matrix.units.data(),
                             size,
                             bias,
                             first > 0,
                             {y.values + row * y.stride, y.stride, y.width}});
    }
    row += count;
  }
}

}  // namespace

bool HasInt16() {
  return __builtin_cpu_supports("avx512vnni") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq");
}

void GemmInt16(const Rows& x, const Int16Matrix& matrix, const float* bias, const Output& y) {
  static const bool has = HasInt16();
  (has ? Gemm : GemmInt16Portable)(x, matrix, bias, y);
}

#else

constexpr auto RoundRow = RoundToInt16;

bool HasInt16() { return false; }

void GemmInt16(const Rows& x, const Int16Matrix& matrix, const float* bias, const Output& y) {
  GemmInt16Portable(x, matrix, bias, y);
}

#endif

Int16Matrix PackInt16(const float* weights, int outputs, int inputs) {
  const int pairs = Pairs(inputs), count = PanelCount(outputs);
  Int16Matrix matrix;
  matrix.panels.resize(static_cast<std::size_t>(std::ptrdiff_t{count} * pairs * kPanel * 2));
  matrix.units.resize(static_cast<std::size_t>(count * kPanel));
  const auto round = HasInt16() ? RoundRow : RoundToInt16;
  std::vector<int16_t> rounded(static_cast<std::size_t>(inputs + kLanes));  // RoundRow's zeros
  for (std::ptrdiff_t n = 0; n < outputs; ++n) {
    matrix.units[static_cast<std::size_t>(n)] = round(weights + n * inputs, inputs, rounded.data());
    int16_t* const to = matrix.panels.data() + (n / kPanel * pairs * kPanel + n % kPanel) * 2;
    for (int k = 0; k < inputs; ++k) {
      to[std::ptrdiff_t{k / 2} * kPanel * 2 + k % 2] = rounded[static_cast<std::size_t>(k)];
    }
  }
  return matrix;
}

}  // namespace duet::cpu_engine::kernels
