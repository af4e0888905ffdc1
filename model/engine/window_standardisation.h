#ifndef DUET_MODEL_ENGINE_WINDOW_STANDARDISATION_H_
#define DUET_MODEL_ENGINE_WINDOW_STANDARDISATION_H_

#include "model/engine/synthesizer.h"
#include "model/motion/skeleton.h"
#include "model/motion/standardise.h"

namespace duet::engine {

// The coordinates in which the network sees a window, in training as in service: the leader's root
// at the origin (in every frame, or in the first one), and -z towards where the follower is
// expected: the window's partner direction; else the follower's start, unless the two stand as good
// as on one spot; else where the leader's hips face. A leader without hips is not turned then.
motion::Standardisation WindowStandardisation(
    const motion::Skeleton& skeleton, const SynthesisWindow& window,
    motion::StandardOrigin origin = motion::StandardOrigin::kEveryFrame);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_WINDOW_STANDARDISATION_H_
