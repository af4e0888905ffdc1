#ifndef DUET_MODEL_CLEANUP_WAIST_H_
#define DUET_MODEL_CLEANUP_WAIST_H_

#include "model/body/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

// The trunk of a person turns by 35 degrees (10) between pelvis and shoulders, and bends by 20 to
// the side (Kapandji, The Physiology of the Joints 3: rotation of the lumbar and thoracic spine).
struct WaistOptions {
  bool enabled = true;
  // Between the lines of shoulders and hips, seen along the trunk. Degrees.
  SoftRange twist = {30, 45};
  // Between the line of the hips and the trunk, from a right angle. Degrees.
  SoftRange tilt = {15, 25};
  // Distance between the hips as a fraction of `width`, beyond which it is corrected.
  double narrowest = 0.85, widest = 1.15;
  // How fast the hips turn about the trunk, degrees per second.
  double fastest_turn = 720;
};

// Turns the hips to within the range of the waist below the shoulders, and gives them the distance
// of a person's hips, and lets them turn as fast as a person can. A network's hips are less certain
// than its shoulders, because they are close together: they can shrink to a point, come out
// reversed, and turn over within a frame. Feet stay where they are, and knees follow. Preserves
// bone lengths, and leaves frames within the ranges unchanged.
//
// Does nothing for a skeleton without named shoulders, a chest, or hips with a common parent. The
// width of the hips is that of the settled frames, or else of the leader (medians).
void LimitWaist(const motion::Skeleton& skeleton, const body::Body& body,
                const motion::Poses& leader, const WaistOptions& options, const Timing& timing,
                motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_WAIST_H_
