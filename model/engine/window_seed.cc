#include "model/engine/window_seed.h"

#include "model/base/split_mix.h"

namespace duet::engine {

uint64_t WindowSeed(uint64_t seed, int window) {
  return window == 0 ? seed : base::SplitMix(seed, static_cast<uint64_t>(window));
}

}  // namespace duet::engine
