#ifndef DUET_MODEL_ENGINE_FINISHING_H_
#define DUET_MODEL_ENGINE_FINISHING_H_

#include "absl/status/status.h"
#include "model/cleanup/clean_up.h"
#include "model/engine/model_description.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// The stages between a network's answer, brought back to the world, and the caller. Metres, y up.
namespace duet::engine {

// INTERNAL when a position is not finite.
absl::Status CheckFinite(const motion::Poses& follower);

// Gives the follower the limb lengths of its start's pose or else the leader's median ones, in
// every frame.
void KeepLimbLengths(const motion::Skeleton& skeleton, const SynthesisWindow& window,
                     motion::Poses* follower);

// Lifts or lowers a follower without a start, as a whole, so that its feet reach as low as the
// leader's. A skeleton without feet tells no floor: nothing changes.
void ShareFloor(const motion::Skeleton& skeleton, const SynthesisWindow& window,
                motion::Poses* follower);

// How far the two may touch in each frame: the weight of the model's touching classes, from 0 to 1.
// Shapes: returns [frames].
cleanup::Touch TouchOf(const ModelDescription& description, const SynthesisWindow& window);

// How many of the window's first frames nothing may change any more: those that are settled, or
// else the one that a start tells.
int SettledFrames(const SynthesisWindow& window);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_FINISHING_H_
