#ifndef DUET_MODEL_CLEANUP_SHOULDERS_H_
#define DUET_MODEL_CLEANUP_SHOULDERS_H_

#include "model/body/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

// The shoulder girdle lifts a shoulder by up to 12 cm when its arm is raised, about 30 degrees of
// the line of the shoulders (Kapandji, The Physiology of the Joints 1: elevation of the scapula).
struct ShoulderOptions {
  bool enabled = true;
  // Between the line of the shoulders and the trunk, from a right angle. Degrees.
  SoftRange tilt = {12, 25};
  // Distance between the shoulders as a fraction of a person's, beyond which it is corrected.
  double narrowest = 0.85, widest = 1.15;
  // How fast the shoulders turn about the trunk, degrees per second. Dancers spin nearly as fast.
  double fastest_turn = 720;
};

// Sets the shoulders across the trunk, as wide as a person's, and lets them turn as fast as a
// person can. A network that is uncertain in which direction a person faces draws the shoulders
// together or tilts them until one is above the other, and turns them over within a frame. Arms
// move with their shoulders, and head and arms turn with them. Preserves bone lengths, and leaves
// frames within the ranges unchanged.
//
// Does nothing for a skeleton without hips, a chest and named shoulders, or whose shoulders are not
// attached to the chest. The width is that of the settled frames, or else of the leader (medians).
void LimitShoulders(const motion::Skeleton& skeleton, const body::Body& body,
                    const motion::Poses& leader, const ShoulderOptions& options,
                    const Timing& timing, motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_SHOULDERS_H_
