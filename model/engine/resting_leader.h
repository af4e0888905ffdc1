#ifndef DUET_MODEL_ENGINE_RESTING_LEADER_H_
#define DUET_MODEL_ENGINE_RESTING_LEADER_H_

#include "absl/types/span.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// Returns what a leader is taken to do after its last known frame, while the true motion is still
// unknown: it comes to rest, with constant limb lengths. Live synthesis and its training share it.
//
// Shapes: known [frames, joints], at least one frame; seconds [n], each above 0, from the last
//         known frame on; returns [n, joints].
motion::Poses ComeToRest(const motion::Skeleton& skeleton, const motion::Poses& known,
                         double frame_rate_hz, absl::Span<const double> seconds);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_RESTING_LEADER_H_
