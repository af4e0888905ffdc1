#ifndef DUET_MODEL_ENGINE_UNFAMILIARITY_H_
#define DUET_MODEL_ENGINE_UNFAMILIARITY_H_

#include <optional>

#include "model/engine/clip_synthesis.h"
#include "model/engine/model_description.h"

namespace duet::engine {

// Returns the distance of a request's leader from the model's training leaders
// (leader_statistics.h), at the model's frame rate. For a clip of several windows, returns the
// value that a tenth of the windows exceeds, so that a long familiar part does not hide an
// unfamiliar one. Absent if the model has no statistics, or if the distance is not finite.
//
// Cost: linear in the clip's length; memory beyond the leader bounded by one window.
std::optional<double> Unfamiliarity(const ModelDescription& model, const ClipRequest& request);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_UNFAMILIARITY_H_
