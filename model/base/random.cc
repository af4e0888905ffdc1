#include "model/base/random.h"

#include <algorithm>
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

}  // namespace

Random::Random(uint64_t seed, int64_t part) {
  SeedSequence sequence{{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32),
                         static_cast<uint32_t>(part), static_cast<uint32_t>(part >> 32)}};
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

}  // namespace duet::base
