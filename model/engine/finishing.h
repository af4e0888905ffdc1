#ifndef DUET_MODEL_ENGINE_FINISHING_H_
#define DUET_MODEL_ENGINE_FINISHING_H_

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/engine/model_description.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/solver/body_model.h"
#include "model/solver/partner.h"

// What the solver and the stages around it take from a window. Metres, y up.
namespace duet::engine {

// Returns INTERNAL if a position is not finite.
absl::Status CheckFinite(const motion::Poses& follower);

// Sets the follower's limb lengths in every frame to those of its start's pose, or else to the
// leader's median lengths times ModelDescription::bone_ratios.
void KeepLimbLengths(const ModelDescription& description, const SynthesisWindow& window,
                     motion::Poses* follower);

// The follower's body: that of its start's pose, or else the leader's in the follower's size.
// Errors: those of BodyModel::Measure.
absl::StatusOr<solver::BodyModel> PersonOf(const ModelDescription& description,
                                           const SynthesisWindow& window);

// Moves a follower without a start vertically so that its lowest foot is as high as the leader's.
// Does nothing for a skeleton without feet.
void ShareFloor(const motion::Skeleton& skeleton, const SynthesisWindow& window,
                motion::Poses* follower);

// The window's first frames as the caller has them: the settled ones and those that were sent, or
// the pose of the start, or none.
motion::Poses GivenFrames(const ModelDescription& description, const SynthesisWindow& window);

// How the two people may touch in each frame, by the labels: a mean of what the classes permit,
// weighted by their positive weights. `body`: of the description's skeleton. Shapes: labels
// [frames, classes]; returns [frames].
solver::ContactRules ContactRulesOf(const ModelDescription& description, const body::Body& body,
                                    absl::Span<const float> labels);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_FINISHING_H_
