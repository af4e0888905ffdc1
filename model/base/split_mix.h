#ifndef DUET_MODEL_BASE_SPLIT_MIX_H_
#define DUET_MODEL_BASE_SPLIT_MIX_H_

#include <cstdint>

namespace duet::base {

// Returns the n-th number of the stream that starts with `seed`: uniform in 64 bits, the same on
// every machine, and computed without its predecessors. Source: Steele, Lea, Flood 2014
// (SplitMix64).
constexpr uint64_t SplitMix(uint64_t seed, uint64_t n) {
  uint64_t bits = seed + n * 0x9e3779b97f4a7c15u;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_SPLIT_MIX_H_
