#ifndef DUET_MODEL_ENGINE_WINDOW_SEED_H_
#define DUET_MODEL_ENGINE_WINDOW_SEED_H_

#include <cstdint>
#include <vector>

#include "model/motion/poses.h"

namespace duet::engine {

// Returns the seed of a window (0 is the first) of a clip that was requested with `seed`. The first
// window has `seed` itself, so that a clip of one window equals the network's own result. Later
// windows have different seeds, which practically never coincide with those of another request.
//
// Source: Steele, Lea, Flood 2014 (SplitMix64): the window-th number of the stream that starts with
// `seed`. The same on every machine. Changing it changes the results of all long clips.
uint64_t WindowSeed(uint64_t seed, int window);

// Returns the seed of a clip whose caller names none: one that differs between leaders, so that
// their followers are different people. It depends on the clip's length and on how far its joints
// move, both rounded, so that another unit or place in the world hardly ever changes it. One of
// `seeds`, or a number below 2^32 if that is empty. Units: metres.
uint64_t LeaderSeed(const motion::Poses& leader, double frame_rate_hz,
                    const std::vector<uint64_t>& seeds);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_WINDOW_SEED_H_
