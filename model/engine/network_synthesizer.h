#ifndef DUET_MODEL_ENGINE_NETWORK_SYNTHESIZER_H_
#define DUET_MODEL_ENGINE_NETWORK_SYNTHESIZER_H_

#include <memory>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/engine/critic.h"
#include "model/engine/model_description.h"
#include "model/engine/network.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"
#include "model/motion/standardise.h"
#include "model/solver/partner.h"

namespace duet::engine {

// A synthesizer around a network:
//   WindowStandardisation, Standardise, Network::Run, Standardisation::Invert, CheckFinite,
//   KeepLimbLengths, ShareFloor, FollowerSolver.
// `origin`: origin of the standard coordinates in which the network was trained. `as_served`: if
// false, the stages after CheckFinite are left out, to measure the network's own answers.
// `critic`: judges several samples of a window, if there is one.
std::unique_ptr<Synthesizer> MakeSynthesizer(ModelDescription description,
                                             motion::StandardOrigin origin,
                                             std::unique_ptr<const Network> network,
                                             bool as_served = true,
                                             std::optional<Critic> critic = std::nullopt);

// Followers as a server would return them if a network had answered so: with the limb lengths of
// the window's start or leader, on the leader's floor, cleaned up. Passing captured followers
// through the same stages makes them comparable with answers: what still tells them apart is the
// motion, not a stage. `followers` in the world, like the leaders of `windows`.
std::vector<WindowResult> FinishMotions(const ModelDescription& description,
                                        const std::vector<SynthesisWindow>& windows,
                                        const std::vector<motion::Poses>& followers);

// How the two people may touch in each frame, by the labels: a mean of what the classes permit,
// weighted by their positive weights. `body`: of the description's skeleton. Shapes: labels
// [frames, classes]; returns [frames].
solver::ContactRules ContactRulesOf(const ModelDescription& description, const body::Body& body,
                                    absl::Span<const float> labels);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_NETWORK_SYNTHESIZER_H_
