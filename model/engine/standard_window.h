#ifndef DUET_MODEL_ENGINE_STANDARD_WINDOW_H_
#define DUET_MODEL_ENGINE_STANDARD_WINDOW_H_

#include "model/engine/network.h"
#include "model/engine/synthesizer.h"
#include "model/motion/standardise.h"

namespace duet::engine {

// Converts a window to the standard coordinates of its leader. The follower's start is relative to
// the leader's first root position.
NetworkInput Standardise(const motion::Standardisation& standardisation,
                         const SynthesisWindow& window);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_STANDARD_WINDOW_H_
