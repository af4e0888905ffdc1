#include "model/cpu_engine/kernels/gemm_bf16.h"

#include <algorithm>
#include <cstring>

#include "model/cpu_engine/kernels/gemm_bf16_amx.h"
#include "model/cpu_engine/kernels/gemm_bf16_portable.h"

#if defined(__x86_64__)
#include "model/cpu_engine/kernels/bf16_rows-inl.h"
#endif

namespace duet::cpu_engine::kernels {

uint16_t ToBf16(float value) {
  uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return static_cast<uint16_t>((bits + 0x7fff + ((bits >> 16) & 1)) >> 16);
}

#if defined(__x86_64__)

namespace {

// Vectors of sums that fit the registers besides the factors, and rows of two such vectors.
constexpr int kSums = 24, kRows = kSums / 2;
// Pairs of inputs that are multiplied before the sums are stored: the rounded rows of a tile stay
// in the first-level cache.
constexpr int kPairsAtOnce = 256;

// A block of inputs of a product, computed tile by tile.
struct Block {
  const uint16_t* x;       // [kRows, 2 kPairsAtOnce], rounded
  const uint16_t* panels;  // from the block's first pair on
  std::ptrdiff_t panel;    // values from one panel to the next
  int pairs;
  const float* bias;  // null without
  bool adds;          // to the sums of earlier blocks in y
  Output y;           // from the tile's first row on
};

// Computes kCount rows by kPanels panels from column `column` on, in registers over the block.
template <int kCount, int kPanels>
DUET_BF16 inline void Tile(const Block& block, int column) {
  const uint16_t* weights = block.panels + column / kPanel * block.panel;
  __mmask16 valid[2 * kPanels];
  __m512 sums[kCount][2 * kPanels];
  for (int v = 0; v < 2 * kPanels; ++v) {
    valid[v] = FirstOf(block.y.width - column - v * kLanes);
    const __m512 begin = block.bias == nullptr || block.adds
                             ? _mm512_setzero_ps()
                             : _mm512_loadu_ps(block.bias + column + v * kLanes);
    for (int r = 0; r < kCount; ++r) {
      sums[r][v] = block.adds
                       ? _mm512_maskz_loadu_ps(
                             valid[v], block.y.values + r * block.y.stride + column + v * kLanes)
                       : begin;
    }
  }
  for (int pair = 0; pair < block.pairs; ++pair, weights += 2 * kPanel) {
    __m512bh w[2 * kPanels];
    for (int v = 0; v < 2 * kPanels; ++v) {
      w[v] = reinterpret_cast<__m512bh>(
          _mm512_loadu_si512(weights + v / 2 * block.panel + v % 2 * kPanel));
    }
    for (int r = 0; r < kCount; ++r) {
      int both;
      std::memcpy(&both, block.x + r * 2 * kPairsAtOnce + 2 * pair, sizeof(both));
      const __m512bh value = reinterpret_cast<__m512bh>(_mm512_set1_epi32(both));
      for (int v = 0; v < 2 * kPanels; ++v) {
        sums[r][v] = _mm512_dpbf16_ps(sums[r][v], value, w[v]);
      }
    }
  }
  for (int r = 0; r < kCount; ++r) {
    float* y = block.y.values + r * block.y.stride + column;
    for (int v = 0; v < 2 * kPanels; ++v) {
      _mm512_mask_storeu_ps(y + v * kLanes, valid[v], sums[r][v]);
    }
  }
}

// Computes all columns of kCount rows, as many at once as the registers hold.
template <int kCount>
DUET_BF16 inline void Strip(const Block& block) {
  constexpr int kPanels = kRows / kCount < 4 ? kRows / kCount : 4;
  int column = 0;
  for (; column + (kPanels - 1) * kPanel < block.y.width; column += kPanels * kPanel) {
    Tile<kCount, kPanels>(block, column);
  }
  for (; column < block.y.width; column += kPanel) Tile<kCount, 1>(block, column);
}

template <int kCount>
DUET_BF16 void StripOf(int count, const Block& block) {
  if (count == kCount) {
    Strip<kCount>(block);
  } else if constexpr (kCount > 1) {
    StripOf<kCount - 1>(count, block);
  }
}

DUET_BF16 void Gemm(const Rows& x, const uint16_t* panels, const float* bias, bool adds,
                    const Output& y) {
  alignas(64) uint16_t rounded[kRows * 2 * kPairsAtOnce];
  const int pairs = Bf16Pairs(x.width);
  for (int row = 0; row < x.count;) {
    const int count = NextTile(x.count - row, kRows);
    for (int first = 0; first < pairs; first += kPairsAtOnce) {
      const int size = std::min(kPairsAtOnce, pairs - first);
      RoundRows<2 * kPairsAtOnce>({x.values + row * x.stride + 2 * first, x.stride, count,
                                   std::min(2 * size, x.width - 2 * first)},
                                  rounded);
      const Output rows{y.values + row * y.stride, y.stride, y.width};
      StripOf<kRows>(count,
                     {rounded, panels + std::ptrdiff_t{first} * 2 * kPanel,
                      std::ptrdiff_t{pairs} * 2 * kPanel, size, bias, adds || first > 0, rows});
    }
    row += count;
  }
}

constexpr __mmask16 kAll = 0xffff;  // GCC 12 reports the forms without a mask as uninitialised

// Rounded values in the lower halves of 32 bits.
DUET_BF16 inline __m512i RoundedWide(const float* from, __mmask16 valid) {
  return _mm512_maskz_cvtepu16_epi32(
      kAll, reinterpret_cast<__m256i>(_mm512_cvtneps_pbh(_mm512_maskz_loadu_ps(valid, from))));
}

// Half a panel of two rows of inputs, or of one and zeros, pair by pair.
DUET_BF16 inline void PackPair(const float* even, const float* odd, __mmask16 valid,
                               uint16_t* pairs) {
  __m512i both = RoundedWide(even, valid);
  if (odd != nullptr) {
    both = _mm512_or_si512(both, _mm512_maskz_slli_epi32(kAll, RoundedWide(odd, valid), 16));
  }
  _mm512_storeu_si512(pairs, both);
}

DUET_BF16 void PackRows(const Rows& inputs, uint16_t* panels) {
  const int pairs = Bf16Pairs(inputs.count);
  for (int pair = 0; pair < pairs; ++pair) {
    const float* even = inputs.values + 2 * pair * inputs.stride;
    const bool has_odd = 2 * pair + 1 < inputs.count;
    for (int column = 0; column < PanelCount(inputs.width) * kPanel; column += kLanes) {
      uint16_t* to = panels + (std::ptrdiff_t{column / kPanel} * pairs + pair) * 2 * kPanel +
                     2 * (column % kPanel);
      PackPair(even + column, has_odd ? even + inputs.stride + column : nullptr,
               FirstOf(inputs.width - column), to);
    }
  }
}

}  // namespace

bool HasBf16() {
  return __builtin_cpu_supports("avx512bf16") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq");
}

bool IsBf16Faster() { return HasAmx() || (HasBf16() && !__builtin_cpu_is("intel")); }

#else

namespace {

void Gemm(const Rows& x, const uint16_t* panels, const float* bias, bool adds, const Output& y) {
  GemmBf16Portable(x, panels, bias, adds, y);
}
void PackRows(const Rows& inputs, uint16_t* panels) { PackRowsBf16Portable(inputs, panels); }

}  // namespace

bool HasBf16() { return false; }

bool IsBf16Faster() { return false; }

#endif

namespace {

using Product = void (*)(const Rows& x, const uint16_t* panels, const float* bias, bool adds,
                         const Output& y);

Product ProductOf(Bf16Product product) {
  switch (product) {
    case Bf16Product::kPortable:
      return GemmBf16Portable;
    case Bf16Product::kAvx512:
      return Gemm;
    case Bf16Product::kAmx:
      return GemmBf16Amx;
    case Bf16Product::kBest:
      break;
  }
  return HasAmx() ? GemmBf16Amx : HasBf16() ? Gemm : GemmBf16Portable;
}

Product& ChosenProduct() {
  static Product product = ProductOf(Bf16Product::kBest);
  return product;
}

}  // namespace

void ChooseBf16Product(Bf16Product product) { ChosenProduct() = ProductOf(product); }

void GemmBf16(const Rows& x, const uint16_t* panels, const float* bias, const Output& y) {
  ChosenProduct()(x, panels, bias, false, y);
}

void AddGemmBf16(const Rows& x, const uint16_t* panels, const Output& y) {
  ChosenProduct()(x, panels, nullptr, true, y);
}

void PackRowsBf16(const Rows& inputs, uint16_t* panels) {
  static const bool has = HasBf16();
  (has ? PackRows : PackRowsBf16Portable)(inputs, panels);
}

}  // namespace duet::cpu_engine::kernels
