#ifndef DUET_MODEL_CLEANUP_CAPSULES_H_
#define DUET_MODEL_CLEANUP_CAPSULES_H_

#include <vector>

#include "model/body/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

struct CapsuleOptions {
  bool enabled = true;
  // Permitted overlap. Captured people overlap as much, because bodies and clothes yield and
  // capsules are approximate.
  double allowed_metres = 0.03;
  // Smallest distance of the two heads' joints, and of the axes of the two trunks, also while the
  // bodies may overlap.
  double heads_metres = 0.2, trunks_metres = 0.18;
  double fastest_metres_per_second = 0.5;  // maximum speed of the correction of a whole body
};

// How far the bodies may overlap in each frame, from 0 (not at all) to 1 (freely, as in an
// embrace).
using Touch = std::vector<float>;

// Both functions limit the overlap of two bodies with the same skeleton. They move only the
// follower, and do nothing for a skeleton without a chest. `radii`: from CapsuleRadii. `leader` and
// `touch` have as many frames as the follower.
//
// Resolves overlaps of trunks and legs: moves the whole follower horizontally.
void PartBodies(const motion::Skeleton& skeleton, const body::Body& body,
                const std::vector<double>& radii, const motion::Poses& leader, const Touch& touch,
                const CapsuleOptions& options, const Timing& timing, motion::Poses* follower);
// Resolves overlaps of the follower's arms with the leader: moves the hands, preserving bone
// lengths.
void PartArms(const motion::Skeleton& skeleton, const body::Body& body,
              const std::vector<double>& radii, const motion::Poses& leader, const Touch& touch,
              const CapsuleOptions& options, const Timing& timing, motion::Poses* follower);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_CAPSULES_H_
