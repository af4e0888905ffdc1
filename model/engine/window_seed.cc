#include "model/engine/window_seed.h"

namespace duet::engine {

uint64_t WindowSeed(uint64_t seed, int window) {
  if (window == 0) return seed;
  uint64_t bits = seed + static_cast<uint64_t>(window) * 0x9e3779b97f4a7c15u;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

}  // namespace duet::engine
