#ifndef DUET_MODEL_ENGINE_STANDARD_WINDOW_H_
#define DUET_MODEL_ENGINE_STANDARD_WINDOW_H_

#include "model/engine/network.h"
#include "model/engine/synthesizer.h"
#include "model/motion/skeleton.h"
#include "model/motion/standardise.h"

namespace duet::engine {

// Returns the coordinates in which the network sees a window, in training and in service. The
// leader's root is at the origin (in every frame, or in the first one). -z points towards the
// follower: along the window's partner direction; else towards the follower's start, unless both
// are at nearly the same position; else in the direction of the leader's hips. A leader without
// hips is not turned.
motion::Standardisation WindowStandardisation(
    const motion::Skeleton& skeleton, const SynthesisWindow& window,
    motion::StandardOrigin origin = motion::StandardOrigin::kEveryFrame);

// Converts a window to the standard coordinates of its leader. The follower's start is relative to
// the leader's first root position.
NetworkInput Standardise(const motion::Standardisation& standardisation,
                         const SynthesisWindow& window);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_STANDARD_WINDOW_H_
