#include "model/cpu_engine/kernels/gemm_bf16_amx.h"

#if defined(__x86_64__) && defined(__linux__)

#include <cpuid.h>
#include <immintrin.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>

#include "model/cpu_engine/kernels/bf16_rows-inl.h"
#include "model/cpu_engine/kernels/gemm_bf16.h"

#define DUET_AMX \
  __attribute__((target("avx512f,avx512bw,avx512vl,avx512dq,avx512bf16,amx-tile,amx-bf16")))

namespace duet::cpu_engine::kernels {
namespace {

constexpr int kTileRows = 16, kTilePairs = 16;
// A strip: two tiles of rows by the two tiles of a panel, with four tiles of sums.
constexpr int kStripRows = 2 * kTileRows;
// Pairs of inputs that are rounded at once: those of a strip fit in half the first-level cache.
constexpr int kPairsAtOnce = 128;
constexpr int kPanelBytes = kPanel * 2 * static_cast<int>(sizeof(uint16_t));
constexpr int kSumsBytes = kPanel * static_cast<int>(sizeof(float));
constexpr int kRoundedBytes = 2 * kPairsAtOnce * static_cast<int>(sizeof(uint16_t));

// The numbers of the tiles, by content: sums of the upper and the lower rows, for the left and the
// right half of a panel; rows; weights. The instructions require constants.
#define DUET_UPPER_LEFT 0
#define DUET_UPPER_RIGHT 1
#define DUET_LOWER_LEFT 2
#define DUET_LOWER_RIGHT 3
#define DUET_UPPER_ROWS 4
#define DUET_LOWER_ROWS 5
#define DUET_LEFT_WEIGHTS 6
#define DUET_RIGHT_WEIGHTS 7

// The layout of LDTILECFG.
struct alignas(64) TileShapes {
  uint8_t palette = 1, start_row = 0, reserved[14] = {};
  uint16_t row_bytes[16] = {};
  uint8_t rows[16] = {};
};

// GCC 12 does not know that tile instructions read memory. This forces earlier writes to memory.
inline void WriteBack() { std::atomic_signal_fence(std::memory_order_seq_cst); }

// Configures tiles for a strip of `rows` rows and steps of `pairs` pairs of inputs, and zeroes
// them.
DUET_AMX void Shape(int rows, int pairs) {
  TileShapes shapes;
  const auto set = [&shapes](int tile, int tile_rows, int bytes) {
    if (tile_rows <= 0) return;
    shapes.rows[tile] = static_cast<uint8_t>(tile_rows);
    shapes.row_bytes[tile] = static_cast<uint16_t>(bytes);
  };
  const int upper = std::min(rows, kTileRows), lower = rows - upper;
  set(DUET_UPPER_LEFT, upper, kSumsBytes / 2);
  set(DUET_UPPER_RIGHT, upper, kSumsBytes / 2);
  set(DUET_LOWER_LEFT, lower, kSumsBytes / 2);
  set(DUET_LOWER_RIGHT, lower, kSumsBytes / 2);
  set(DUET_UPPER_ROWS, upper, 4 * pairs);
  set(DUET_LOWER_ROWS, lower, 4 * pairs);
  set(DUET_LEFT_WEIGHTS, pairs, kPanelBytes / 2);
  set(DUET_RIGHT_WEIGHTS, pairs, kPanelBytes / 2);
  WriteBack();
  _tile_loadconfig(&shapes);
}

// One block of a strip's product.
struct Block {
  const uint16_t* x;        // [kStripRows, 2 kPairsAtOnce], rounded
  const uint16_t* weights;  // of one panel, from the block's first pair on
  int pairs, pairs_a_step;  // pairs is a multiple of pairs_a_step
};

// Sums of a strip over one panel: [kStripRows, kPanel]. Only the strip's rows are written.
template <bool kTwoTiles>
DUET_AMX void SumPanel(const Block& block, float* sums) {
  _tile_zero(DUET_UPPER_LEFT);
  _tile_zero(DUET_UPPER_RIGHT);
  if constexpr (kTwoTiles) {
    _tile_zero(DUET_LOWER_LEFT);
    _tile_zero(DUET_LOWER_RIGHT);
  }
  for (int pair = 0; pair < block.pairs; pair += block.pairs_a_step) {
    const uint16_t* const weights = block.weights + 2 * kPanel * pair;
    const uint16_t* const x = block.x + 2 * pair;
    _tile_loadd(DUET_LEFT_WEIGHTS, weights, kPanelBytes);
    _tile_loadd(DUET_RIGHT_WEIGHTS, weights + kPanel, kPanelBytes);
    _tile_loadd(DUET_UPPER_ROWS, x, kRoundedBytes);
    _tile_dpbf16ps(DUET_UPPER_LEFT, DUET_UPPER_ROWS, DUET_LEFT_WEIGHTS);
    _tile_dpbf16ps(DUET_UPPER_RIGHT, DUET_UPPER_ROWS, DUET_RIGHT_WEIGHTS);
    if constexpr (kTwoTiles) {
      _tile_loadd(DUET_LOWER_ROWS, x + kTileRows * 2 * kPairsAtOnce, kRoundedBytes);
      _tile_dpbf16ps(DUET_LOWER_LEFT, DUET_LOWER_ROWS, DUET_LEFT_WEIGHTS);
      _tile_dpbf16ps(DUET_LOWER_RIGHT, DUET_LOWER_ROWS, DUET_RIGHT_WEIGHTS);
    }
  }
  _tile_stored(DUET_UPPER_LEFT, sums, kSumsBytes);
  _tile_stored(DUET_UPPER_RIGHT, sums + kPanel / 2, kSumsBytes);
  if constexpr (kTwoTiles) {
    float* const lower = sums + kTileRows * kPanel;
    _tile_stored(DUET_LOWER_LEFT, lower, kSumsBytes);
    _tile_stored(DUET_LOWER_RIGHT, lower + kPanel / 2, kSumsBytes);
  }
}

// A strip's part of y from `column` on: its initial values and its sums.
DUET_AMX void Add(const float* sums, int rows, int column, const float* bias, bool adds,
                  const Output& y) {
  for (int half = 0; half < kPanel; half += kLanes) {
    const __mmask16 valid = FirstOf(y.width - column - half);
    const __m512 begin =
        bias == nullptr || adds ? _mm512_setzero_ps() : _mm512_loadu_ps(bias + column + half);
    for (int r = 0; r < rows; ++r) {
      float* const to = y.values + r * y.stride + column + half;
      const __m512 from = adds ? _mm512_maskz_loadu_ps(valid, to) : begin;
      _mm512_mask_storeu_ps(to, valid,
                            _mm512_add_ps(from, _mm512_load_ps(sums + r * kPanel + half)));
    }
  }
}

// The product of one strip: its rows of the matrices.
struct Strip {
  Rows x;
  const uint16_t* panels;
  const float* bias;
  Output y;
};

// Multiplies `pairs` pairs of a strip's inputs from `first` on.
DUET_AMX void AddPairs(const Strip& strip, int first, int pairs, bool adds) {
  alignas(64) uint16_t rounded[kStripRows * 2 * kPairsAtOnce];
  alignas(64) float sums[kStripRows * kPanel];
  RoundRows<2 * kPairsAtOnce>({strip.x.values + 2 * first, strip.x.stride, strip.x.count,
                               std::min(2 * pairs, strip.x.width - 2 * first)},
                              rounded);
  const int step = std::min(pairs, kTilePairs);
  Shape(strip.x.count, step);
  const std::ptrdiff_t panel = std::ptrdiff_t{Bf16Pairs(strip.x.width)} * 2 * kPanel;
  const uint16_t* weights = strip.panels + std::ptrdiff_t{first} * 2 * kPanel;
  for (int column = 0; column < strip.y.width; column += kPanel, weights += panel) {
    const Block block{rounded, weights, pairs, step};
    strip.x.count > kTileRows ? SumPanel<true>(block, sums) : SumPanel<false>(block, sums);
    Add(sums, strip.x.count, column, strip.bias, adds, strip.y);
  }
}

// Releases the tiles, which makes context switches cheaper and allows deeper idle states.
DUET_AMX void Release() { _tile_release(); }

bool ProcessorHasAmx() {
  constexpr unsigned kBf16Bit = 1u << 22, kTileBit = 1u << 24;
  unsigned eax, ebx, ecx, edx;
  return __get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx) != 0 && (edx & kBf16Bit) != 0 &&
         (edx & kTileBit) != 0;
}

// Linux 5.16 and later save tiles for the threads of a process that requested it (xstate.rst in its
// documentation). Older kernels reject the request.
bool KernelKeepsTiles() {
  constexpr int kRequestPermission = 0x1023, kTileData = 18;
  return syscall(SYS_arch_prctl, kRequestPermission, kTileData) == 0;
}

}  // namespace

bool HasAmx() {
  static const bool has = HasBf16() && ProcessorHasAmx() && KernelKeepsTiles();
  return has;
}

void GemmBf16Amx(const Rows& x, const uint16_t* panels, const float* bias, bool adds,
                 const Output& y) {
  const int pairs = Bf16Pairs(x.width);
  const int in_whole_steps = pairs / kTilePairs * kTilePairs;
  for (int row = 0; row < x.count; row += kStripRows) {
    const Strip strip{
        {x.values + row * x.stride, x.stride, std::min(kStripRows, x.count - row), x.width},
        panels,
        bias,
        {y.values + row * y.stride, y.stride, y.width}};
    for (int first = 0; first < in_whole_steps; first += kPairsAtOnce) {
      AddPairs(strip, first, std::min(kPairsAtOnce, in_whole_steps - first), adds || first > 0);
    }
    if (in_whole_steps < pairs) {
      AddPairs(strip, in_whole_steps, pairs - in_whole_steps, adds || in_whole_steps > 0);
    }
  }
  if (x.count > 0) Release();
}

}  // namespace duet::cpu_engine::kernels

#else

#include "model/cpu_engine/kernels/gemm_bf16_portable.h"

namespace duet::cpu_engine::kernels {

bool HasAmx() { return false; }

void GemmBf16Amx(const Rows& x, const uint16_t* panels, const float* bias, bool adds,
                 const Output& y) {
  GemmBf16Portable(x, panels, bias, adds, y);
}

}  // namespace duet::cpu_engine::kernels

#endif
