#ifndef DUET_MODEL_CLEANUP_CAPSULES_H_
#define DUET_MODEL_CLEANUP_CAPSULES_H_

#include <vector>

#include "model/cleanup/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

struct CapsuleOptions {
  bool enabled = true;
  // Bodies give way, clothes and capsules are rough: captured people overlap as much.
  double allowed_metres = 0.03;
  double fastest_metres_per_second = 0.5;  // at which a whole body makes room
};

// How far each frame's bodies may touch: 0 not at all, 1 as they like (an embrace).
using Touch = std::vector<float>;

// Both keep two bodies of one skeleton from passing through each other by more than allowed, moving
// the follower alone; a skeleton without a chest stays as it is. `radii` are CapsuleRadii's; frames
// of `leader` and `touch` as the follower's.
//
// Where trunks or legs overlap the whole follower makes room horizontally.
void PartBodies(const motion::Skeleton& skeleton, const Body& body,
                const std::vector<double>& radii, const motion::Poses& leader, const Touch& touch,
                const CapsuleOptions& options, const Timing& timing, motion::Poses* follower);
// Arms that reach into the leader are taken out of it, hand first, bones keeping their lengths.
void PartArms(const motion::Skeleton& skeleton, const Body& body, const std::vector<double>& radii,
              const motion::Poses& leader, const Touch& touch, const CapsuleOptions& options,
              const Timing& timing, motion::Poses* follower);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_CAPSULES_H_
