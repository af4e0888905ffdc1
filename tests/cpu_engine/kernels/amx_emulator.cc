#include "tests/cpu_engine/kernels/amx_emulator.h"

#if defined(__x86_64__) && defined(__linux__)

#include <signal.h>
#include <ucontext.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace duet::cpu_engine::kernels {
namespace {

constexpr int kTiles = 8, kRows = 16, kRowBytes = 64;

struct Tile {
  int rows = 0, row_bytes = 0;
  uint8_t values[kRows][kRowBytes] = {};
};

struct Tiles {
  bool shaped = false;
  Tile tiles[kTiles];
};

Tiles state;
int64_t done = 0;
struct sigaction before;

// A VEX-encoded instruction with a prefix of three bytes, as all of AMX have.
struct Instruction {
  int map, prefix, opcode;               // prefix: 0 none, 1 66, 2 F3, 3 F2
  int mode, reg, rm;                     // of ModRM; reg and rm with VEX's bits
  int second;                            // VEX.vvvv
  int base = -1, index = -1, shift = 0;  // of SIB; -1: none
  int64_t displacement = 0;
  int length = 0;
};

// Registers in the order that instructions number them.
constexpr int kRegisters[16] = {REG_RAX, REG_RCX, REG_RDX, REG_RBX, REG_RSP, REG_RBP,
                                REG_RSI, REG_RDI, REG_R8,  REG_R9,  REG_R10, REG_R11,
                                REG_R12, REG_R13, REG_R14, REG_R15};

template <typename T>
T Read(const uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

// Decodes the address bytes after ModRM. False if relative to the next instruction: unsupported.
bool DecodeAddress(const uint8_t* bytes, int extra_base, int extra_index, Instruction& decoded) {
  const uint8_t* at = bytes + decoded.length;
  const int low = decoded.rm & 7;
  if (low == 4) {
    const uint8_t sib = *at++;
    decoded.shift = sib >> 6;
    decoded.index = ((sib >> 3) & 7) | extra_index;
    if (decoded.index == 4) decoded.index = -1;
    decoded.base = (sib & 7) | extra_base;
  } else {
    decoded.base = decoded.rm;
  }
  if (decoded.mode == 0 && (decoded.base & 7) == 5) return false;
  if (decoded.mode == 1) {
    decoded.displacement = Read<int8_t>(at);
    at += 1;
  } else if (decoded.mode == 2) {
    decoded.displacement = Read<int32_t>(at);
    at += 4;
  }
  decoded.length = static_cast<int>(at - bytes);
  return true;
}

bool Decode(const uint8_t* bytes, Instruction& decoded) {
  if (bytes[0] != 0xc4) return false;
  const bool r = (bytes[1] & 0x80) == 0, x = (bytes[1] & 0x40) == 0, b = (bytes[1] & 0x20) == 0;
  decoded.map = bytes[1] & 0x1f;
  decoded.prefix = bytes[2] & 3;
  decoded.second = (~bytes[2] >> 3) & 15;
  decoded.opcode = bytes[3];
  decoded.mode = bytes[4] >> 6;
  decoded.reg = ((bytes[4] >> 3) & 7) | (r ? 8 : 0);
  decoded.rm = (bytes[4] & 7) | (b ? 8 : 0);
  decoded.length = 5;
  const bool wide_or_long = (bytes[2] & 0x84) != 0;  // W1 or 256 bits: none of these
  if (decoded.map != 2 || wide_or_long) return false;
  return decoded.mode == 3 || DecodeAddress(bytes, b ? 8 : 0, x ? 8 : 0, decoded);
}

int64_t Register(const ucontext_t& context, int number) {
  return number < 0 ? 0 : context.uc_mcontext.gregs[kRegisters[number]];
}

// LDTILECFG.
bool Shape(const uint8_t* from) {
  Tiles shaped;
  shaped.shaped = true;
  bool valid = from[0] == 1;
  for (int i = 1; i < 16; ++i) valid = valid && from[i] == 0;
  for (int t = 0; t < 16; ++t) {
    const int row_bytes = Read<uint16_t>(from + 16 + 2 * t), rows = from[48 + t];
    if (t >= kTiles) {
      valid = valid && row_bytes == 0 && rows == 0;
      continue;
    }
    valid = valid && row_bytes <= kRowBytes && rows <= kRows && (row_bytes == 0) == (rows == 0);
    shaped.tiles[t].rows = rows;
    shaped.tiles[t].row_bytes = row_bytes;
  }
  if (valid) state = shaped;
  return valid;
}

Tile* ShapedTile(int number) {
  if (!state.shaped || number >= kTiles || state.tiles[number].rows == 0) return nullptr;
  return &state.tiles[number];
}

void Zero(Tile& tile) { std::memset(tile.values, 0, sizeof(tile.values)); }

// Denormal inputs and outputs become zero.
float Flushed(float value) {
  const bool denormal = value != 0 && std::abs(value) < std::numeric_limits<float>::min();
  return denormal ? std::copysign(0.0f, value) : value;
}

float Bf16(const uint8_t* from) {
  const uint32_t bits = uint32_t{Read<uint16_t>(from)} << 16;
  float value;
  std::memcpy(&value, &bits, sizeof(value));
  return Flushed(value);
}

// One row of TDPBF16PS: sums the even and the odd halves of pairs separately, then adds them.
void AddRow(const uint8_t* x, int pairs, const Tile& weights, uint8_t* sums, int columns) {
  std::array<float, 2 * kRowBytes / 4> halves{};
  for (int k = 0; k < pairs; ++k) {
    for (int half = 0; half < 2 * columns; ++half) {
      float& sum = halves[static_cast<std::size_t>(half)];
      sum = Flushed(
          std::fma(Bf16(x + 4 * k + 2 * (half % 2)), Bf16(weights.values[k] + 2 * half), sum));
    }
  }
  for (int n = 0; n < columns; ++n) {
    const auto even = static_cast<std::size_t>(2 * n);
    const float both = Flushed(halves[even] + halves[even + 1]);
    const float sum = Flushed(Flushed(Read<float>(sums + 4 * n)) + both);
    std::memcpy(sums + 4 * n, &sum, sizeof(sum));
  }
}

bool Multiply(Tile* sums, const Tile* x, const Tile* weights) {
  if (sums == nullptr || x == nullptr || weights == nullptr) return false;
  if (sums == x || sums == weights || x == weights) return false;
  if (sums->rows != x->rows || sums->row_bytes != weights->row_bytes) return false;
  if (x->row_bytes % 4 != 0 || sums->row_bytes % 4 != 0 || x->row_bytes / 4 != weights->rows) {
    return false;
  }
  for (int m = 0; m < sums->rows; ++m) {
    AddRow(x->values[m], x->row_bytes / 4, *weights, sums->values[m], sums->row_bytes / 4);
  }
  return true;
}

// TILELOADD and TILESTORED: row r is at base + displacement + r times the scaled index.
bool Move(Tile* tile, const ucontext_t& context, const Instruction& decoded, bool loads) {
  if (tile == nullptr || decoded.mode == 3 || (decoded.rm & 7) != 4) return false;
  const int64_t from = Register(context, decoded.base) + decoded.displacement;
  const int64_t stride = Register(context, decoded.index) << decoded.shift;
  if (loads) Zero(*tile);
  for (int r = 0; r < tile->rows; ++r) {
    void* const memory = reinterpret_cast<void*>(from + r * stride);
    const auto size = static_cast<std::size_t>(tile->row_bytes);
    loads ? std::memcpy(tile->values[r], memory, size) : std::memcpy(memory, tile->values[r], size);
  }
  return true;
}

bool Do(const Instruction& decoded, const ucontext_t& context) {
  enum Prefix { kNone, k66, kF3, kF2 };
  const bool registers = decoded.mode == 3;
  switch (decoded.opcode << 4 | decoded.prefix) {
    case 0x49 << 4 | kNone:
      if (registers) {  // TILERELEASE
        state = Tiles();
        return true;
      }
      return Shape(
          reinterpret_cast<const uint8_t*>(Register(context, decoded.base) + decoded.displacement +
                                           (Register(context, decoded.index) << decoded.shift)));
    case 0x49 << 4 | kF2: {  // TILEZERO
      Tile* const tile = registers ? ShapedTile(decoded.reg) : nullptr;
      if (tile != nullptr) Zero(*tile);
      return tile != nullptr;
    }
    case 0x4b << 4 | kF2:
      return Move(ShapedTile(decoded.reg), context, decoded, /*loads=*/true);
    case 0x4b << 4 | kF3:
      return Move(ShapedTile(decoded.reg), context, decoded, /*loads=*/false);
    case 0x5c << 4 | kF3:
      return registers &&
             Multiply(ShapedTile(decoded.reg), ShapedTile(decoded.rm), ShapedTile(decoded.second));
    default:
      return false;
  }
}

void OnIllegalInstruction(int, siginfo_t*, void* raw) {
  ucontext_t& context = *static_cast<ucontext_t*>(raw);
  greg_t& next = context.uc_mcontext.gregs[REG_RIP];
  Instruction decoded;
  if (!Decode(reinterpret_cast<const uint8_t*>(next), decoded) || !Do(decoded, context)) {
    sigaction(SIGILL, &before, nullptr);  // the signal repeats and ends the process
    return;
  }
  ++done;
  next += decoded.length;
}

}  // namespace

AmxEmulator::AmxEmulator() {
  state = Tiles();
  done = 0;
  struct sigaction action = {};
  action.sa_sigaction = OnIllegalInstruction;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGILL, &action, &before);
}

AmxEmulator::~AmxEmulator() { sigaction(SIGILL, &before, nullptr); }

int64_t AmxEmulator::instructions() const { return done; }
bool AmxEmulator::in_use() const { return state.shaped; }

}  // namespace duet::cpu_engine::kernels

#else

namespace duet::cpu_engine::kernels {

AmxEmulator::AmxEmulator() = default;
AmxEmulator::~AmxEmulator() = default;
int64_t AmxEmulator::instructions() const { return 0; }
bool AmxEmulator::in_use() const { return false; }

}  // namespace duet::cpu_engine::kernels

#endif
