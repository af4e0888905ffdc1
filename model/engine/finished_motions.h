#ifndef DUET_MODEL_ENGINE_FINISHED_MOTIONS_H_
#define DUET_MODEL_ENGINE_FINISHED_MOTIONS_H_

#include <vector>

#include "model/engine/model_description.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"

namespace duet::engine {

// Followers as a server would return them if a network had answered so: with the limb lengths of
// the window's start or leader, on the leader's floor, cleaned up. Passing captured followers
// through the same stages makes them comparable with answers: what still tells them apart is the
// motion, not a stage. `followers` in the world, like the leaders of `windows`.
std::vector<WindowResult> FinishMotions(const ModelDescription& description,
                                        const std::vector<SynthesisWindow>& windows,
                                        const std::vector<motion::Poses>& followers);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_FINISHED_MOTIONS_H_
