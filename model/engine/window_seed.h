#ifndef DUET_MODEL_ENGINE_WINDOW_SEED_H_
#define DUET_MODEL_ENGINE_WINDOW_SEED_H_

#include <cstdint>

namespace duet::engine {

// The seed of a clip's window, 0 the first, where the clip was asked for with `seed`. The first
// window's is `seed` itself, so that a clip of one window is what the network draws with it; each
// later window draws numbers of its own, of which no two requests share any to speak of.
//
// Source: Steele, Lea, Flood 2014 (SplitMix64): the window-th number of the stream that `seed`
// begins. The same on every machine; changing it changes every long answer.
uint64_t WindowSeed(uint64_t seed, int window);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_WINDOW_SEED_H_
