#include "model/base/random.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "model/base/angle.h"

namespace duet::base {
namespace {

constexpr int kSpareBits = 64 - 53;  // a double has 53 significant bits
constexpr double kStep = 0x1.0p-53;

// Equals std::seed_seq of four numbers, but does not allocate.
// Source: ISO C++17, [rand.util.seedseq].
struct SeedSequence {
  using result_type = uint32_t;
  static constexpr uint32_t kCount = 4;
  uint32_t numbers[kCount];

  // Requires at least kCount numbers. Every engine of the standard asks for several hundred.
  template <typename Iterator>
  void generate(Iterator begin, Iterator end) const {
    const auto n = static_cast<uint32_t>(end - begin);
    const uint32_t t = n >= 623 ? 11 : n >= 68 ? 7 : n >= 39 ? 5 : n >= 7 ? 3 : (n - 1) / 2;
    const uint32_t p = (n - t) / 2, q = p + t, m = std::max(kCount + 1, n);
    const auto at = [&](uint32_t k) -> auto& { return begin[k % n]; };
    const auto mixed = [](uint32_t x) { return x ^ (x >> 27); };
    std::fill(begin, end, 0x8b8b8b8bu);
    for (uint32_t k = 0; k < m; ++k) {
      const auto r1 = static_cast<uint32_t>(
          1664525u * mixed(static_cast<uint32_t>(at(k) ^ at(k + p) ^ at(k + n - 1))));
      const uint32_t r2 = r1 + (k == 0 ? kCount : k % n + (k <= kCount ? numbers[k - 1] : 0));
      at(k + p) += r1;
      at(k + q) += r2;
      at(k) = r2;
    }
    for (uint32_t k = m; k < m + n; ++k) {
      const auto r3 = static_cast<uint32_t>(
          1566083941u * mixed(static_cast<uint32_t>(at(k) + at(k + p) + at(k + n - 1))));
      const uint32_t r4 = r3 - k % n;
      at(k + p) ^= r3;
      at(k + q) ^= r4;
      at(k) = r4;
    }
  }
};

// The seeds of a part of a run; see Random.
SeedSequence SeedsOfPart(uint64_t seed, int64_t part) {
  return {{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32),
           static_cast<uint32_t>(part), static_cast<uint32_t>(part >> 32)}};
}

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

Random::Random(uint64_t seed, int64_t part) {
  const SeedSequence sequence = SeedsOfPart(seed, part);
  bits_.seed(sequence);
}

double Random::Uniform() { return static_cast<double>(bits_() >> kSpareBits) * kStep; }

double Random::OpenUniform() { return (static_cast<double>(bits_() >> kSpareBits) + 0.5) * kStep; }

int64_t Random::Below(int64_t end) {
  return static_cast<int64_t>(bits_() % static_cast<uint64_t>(end));
}

double Random::Normal(double deviation) {
  const double radius = std::sqrt(-2 * std::log(1 - Uniform()));
  return deviation * radius * std::cos(2 * kPi * Uniform());
}

double Random::StandardNormal() {
  const double radius = std::sqrt(-2 * std::log(OpenUniform()));
  return radius * std::cos(2 * kPi * OpenUniform());
}

void FillOpenUniform(uint64_t seed, int64_t part, std::ptrdiff_t count, double* out) {
  static const bool wide = HasWide();
  MersenneBlocks blocks(SeedsOfPart(seed, part));
  (wide ? FillWide : FillAnywhere)(blocks, count, out);
}

}  // namespace duet::base
