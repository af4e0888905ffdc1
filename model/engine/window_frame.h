#ifndef DUET_MODEL_ENGINE_WINDOW_FRAME_H_
#define DUET_MODEL_ENGINE_WINDOW_FRAME_H_

#include "model/engine/synthesizer.h"
#include "model/motion/skeleton.h"
#include "model/motion/standardise.h"

namespace duet {

// The frame in which the network sees a window, in training as in service: the leader's root at the
// origin (in every frame, or in the first one), and -z towards where the follower is expected: the
// window's partner direction; else the follower's start, unless the two stand as good as on one
// spot; else where the leader's hips face.
Standardisation WindowFrame(const Skeleton& skeleton, const SynthesisWindow& window,
                            StandardOrigin origin = StandardOrigin::kEveryFrame);

}  // namespace duet

#endif  // DUET_MODEL_ENGINE_WINDOW_FRAME_H_
