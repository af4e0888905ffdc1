#ifndef DUET_MODEL_BASE_SEED_SEQUENCE_H_
#define DUET_MODEL_BASE_SEED_SEQUENCE_H_

#include <algorithm>
#include <cstdint>

namespace duet::base {

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
inline SeedSequence SeedsOfPart(uint64_t seed, int64_t part) {
  return {{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32),
           static_cast<uint32_t>(part), static_cast<uint32_t>(part >> 32)}};
}

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_SEED_SEQUENCE_H_
