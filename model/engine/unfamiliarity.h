#ifndef DUET_MODEL_ENGINE_UNFAMILIARITY_H_
#define DUET_MODEL_ENGINE_UNFAMILIARITY_H_

#include <optional>

#include "model/engine/clip_synthesis.h"
#include "model/engine/model_description.h"

namespace duet::engine {

// How far a request's leader is from the model's training leaders (leader_statistics.h), at the
// model's frame rate. A clip of several windows is as far as the farthest tenth of them: a minute
// of good motion does not make up for ten seconds that the model has to guess at. Absent where the
// model has no statistics, or where no number holds the distance.
//
// Cost: linear in the clip's length; memory beyond the leader bounded by one window.
std::optional<double> Unfamiliarity(const ModelDescription& model, const ClipRequest& request);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_UNFAMILIARITY_H_
