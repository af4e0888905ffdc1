#ifndef DUET_SERVER_REGISTRY_GOLDEN_CHECK_H_
#define DUET_SERVER_REGISTRY_GOLDEN_CHECK_H_

#include "absl/status/status.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::server::registry {

// How far from its leader a follower may be, metres: captured pairs stay within 3.
inline constexpr float kFarthestFollower = 8;

// A leader made of formulas that any skeleton can move: stands on the floor at the origin, sways
// and swings its limbs. Shapes: [frames, joints]. Units: metres, y up.
motion::Poses GoldenLeader(const motion::Skeleton& skeleton, int frames, double frame_rate_hz);

// Whether a model that has just been loaded answers sensibly: it is asked for one window of a fixed
// leader with no class at all and with each class alone, without clean-up. The evaluation also
// warms the model up. Fails with INVALID_ARGUMENT when a joint of an answer is not finite or
// farther from the leader's root than kFarthestFollower, as the answers of weights out of all
// proportion are; with the model's own status when it fails.
absl::Status CheckAnswers(const engine::Synthesizer& model);

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_GOLDEN_CHECK_H_
