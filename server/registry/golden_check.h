#ifndef DUET_SERVER_REGISTRY_GOLDEN_CHECK_H_
#define DUET_SERVER_REGISTRY_GOLDEN_CHECK_H_

#include "absl/status/status.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::server::registry {

// Maximum distance of a follower from its leader, metres. In captured pairs it is at most 3.
inline constexpr float kFarthestFollower = 8;

// Returns a synthetic leader for any skeleton: it stands on the floor at the origin, sways, and
// swings its limbs. Shapes: [frames, joints]. Units: metres, y up.
motion::Poses GoldenLeader(const motion::Skeleton& skeleton, int frames, double frame_rate_hz);

// Checks that a newly loaded model returns plausible results, and warms it up. Evaluates one window
// of a fixed leader without a class and with each class, without clean-up. Returns INVALID_ARGUMENT
// if a joint is not finite or farther from the leader's root than kFarthestFollower, which
// indicates corrupt weights; or the model's own error.
absl::Status CheckAnswers(const engine::Synthesizer& model);

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_GOLDEN_CHECK_H_
