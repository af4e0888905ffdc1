#include "model/base/open_uniforms.h"

#include <algorithm>
#include <array>

#include "model/base/seed_sequence.h"

namespace duet::base {
namespace {

constexpr int kSpareBits = 64 - 53;  // a double has 53 significant bits
constexpr double kStep = 0x1.0p-53;

// Compiled into the function that calls it, for that function's instruction set.
#define DUET_INTO_CALLER __attribute__((always_inline)) inline

// std::mt19937_64 with the state as a block. The loops have no branches and no dependence between
// neighbours, so that compilers vectorise them. Source: ISO C++17, [rand.eng.mers].
class MersenneBlocks {
 public:
  static constexpr int kWords = 312;

  explicit MersenneBlocks(const SeedSequence& seeds) {
    std::array<uint32_t, 2 * kWords> halves;
    seeds.generate(halves.begin(), halves.end());
    for (int i = 0; i < kWords; ++i) {
      words_[i] = halves[static_cast<std::size_t>(2 * i)] |
                  uint64_t{halves[static_cast<std::size_t>(2 * i + 1)]} << 32;
    }
    // A state of zeros would stay so.
    const bool is_zero =
        words_[0] >> kLowBits == 0 &&
        std::all_of(words_ + 1, words_ + kWords, [](uint64_t w) { return w == 0; });
    if (is_zero) words_[0] = uint64_t{1} << 63;
  }

  // The next block, before tempering.
  DUET_INTO_CALLER const uint64_t* Next() {
    for (int i = 0; i < kWords - kShift; ++i) words_[i] = Mixed(i, i + 1) ^ words_[i + kShift];
    for (int i = kWords - kShift; i < kWords - 1; ++i) {
      words_[i] = Mixed(i, i + 1) ^ words_[i + kShift - kWords];
    }
    words_[kWords - 1] = Mixed(kWords - 1, 0) ^ words_[kShift - 1];
    return words_;
  }

  DUET_INTO_CALLER static uint64_t Tempered(uint64_t word) {
    word ^= (word >> 29) & 0x5555555555555555;
    word ^= (word << 17) & 0x71d67fffeda60000;
    word ^= (word << 37) & 0xfff7eee000000000;
    return word ^ (word >> 43);
  }

 private:
  static constexpr int kShift = 156, kLowBits = 31;

  DUET_INTO_CALLER uint64_t Mixed(int high, int low) const {
    constexpr uint64_t kLow = (uint64_t{1} << kLowBits) - 1, kTwist = 0xb5026f5aa96619e9;
    const uint64_t y = (words_[high] & ~kLow) | (words_[low] & kLow);
    return (y >> 1) ^ (-(y & 1) & kTwist);
  }

  uint64_t words_[kWords];
};

DUET_INTO_CALLER void Fill(MersenneBlocks& blocks, std::ptrdiff_t count, double* out) {
  while (count > 0) {
    const uint64_t* const words = blocks.Next();
    const std::ptrdiff_t now = std::min<std::ptrdiff_t>(count, MersenneBlocks::kWords);
    for (std::ptrdiff_t i = 0; i < now; ++i) {
      // A number of 53 bits is the same as a signed one, which converts faster.
      const auto bits = static_cast<int64_t>(MersenneBlocks::Tempered(words[i]) >> kSpareBits);
      out[i] = (static_cast<double>(bits) + 0.5) * kStep;
    }
    out += now;
    count -= now;
  }
}

void FillAnywhere(MersenneBlocks& blocks, std::ptrdiff_t count, double* out) {
  Fill(blocks, count, out);
}

#if defined(__x86_64__)
// Converts eight integers at once; the baseline converts one.
__attribute__((target("avx512f,avx512dq"))) void FillWide(MersenneBlocks& blocks,
                                                          std::ptrdiff_t count, double* out) {
  Fill(blocks, count, out);
}
bool HasWide() { return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"); }
#else
constexpr auto FillWide = FillAnywhere;
bool HasWide() { return false; }
#endif

}  // namespace

void FillOpenUniform(uint64_t seed, int64_t part, std::ptrdiff_t count, double* out) {
  static const bool wide = HasWide();
  MersenneBlocks blocks(SeedsOfPart(seed, part));
  (wide ? FillWide : FillAnywhere)(blocks, count, out);
}

}  // namespace duet::base
