#ifndef DUET_MODEL_ENGINE_WINDOW_SEED_H_
#define DUET_MODEL_ENGINE_WINDOW_SEED_H_

#include <cstdint>

namespace duet::engine {

// Returns the seed of a window (0 is the first) of a clip that was requested with `seed`. The first
// window has `seed` itself, so that a clip of one window equals the network's own result. Later
// windows have different seeds, which practically never coincide with those of another request.
//
// Source: Steele, Lea, Flood 2014 (SplitMix64): the window-th number of the stream that starts with
// `seed`. The same on every machine. Changing it changes the results of all long clips.
uint64_t WindowSeed(uint64_t seed, int window);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_WINDOW_SEED_H_
