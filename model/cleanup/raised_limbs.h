#ifndef DUET_MODEL_CLEANUP_RAISED_LIMBS_H_
#define DUET_MODEL_CLEANUP_RAISED_LIMBS_H_

#include <optional>

#include "model/body/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

struct RaisedLimbOptions {
  bool enabled = true;
  // A foot that is this high above the floor for longer than that comes down.
  double foot_metres = 0.12, longest_foot_seconds = 0.8;
  // The same for a hand above its shoulder, unless a hand of the leader is this near.
  double hand_metres = 0.15, longest_hand_seconds = 1.5;
  double held_metres = 0.35;
  // A hand that is held out (body::IsHeldOut) for longer than this comes down, too. 0: never.
  double longest_held_out_seconds = 0;
  // How long a limb takes to come down.
  double ease_seconds = 0.5;
};

// Brings down limbs that stay up for longer than people keep them up: a foot to the floor below its
// hip, a hand beside the body. Networks that go on from their own frames can leave a leg or an arm
// in the air for many seconds. A motion without settled frames does not begin with a raised foot.
// Moves limbs by rotating their bones. Does nothing to feet without a `floor`, nor to hands of a
// skeleton without two named arms. Shapes: leader like the follower.
void LowerLimbs(const motion::Skeleton& skeleton, const body::Body& body,
                std::optional<float> floor, const motion::Poses& leader,
                const RaisedLimbOptions& options, const Timing& timing, motion::Poses* follower);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_RAISED_LIMBS_H_
