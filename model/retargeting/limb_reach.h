#ifndef DUET_MODEL_RETARGETING_LIMB_REACH_H_
#define DUET_MODEL_RETARGETING_LIMB_REACH_H_

#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// The pose of a limb of two bones whose end is at a target.
struct LimbPose {
  Vec3d upper, lower;  // the directions of the bones, of length 1
  // The axis of the joint between them, of length 1 and perpendicular to both bones: a rotation
  // about it takes the upper bone's direction to the lower one's.
  Vec3d hinge;
};

// Reaches from `start` to `target`, or as near as the bones allow. `pole`, of length 1, is the
// direction in which the elbow or knee points.
LimbPose ReachFor(Vec3d start, Vec3d target, double upper_length, double lower_length, Vec3d pole);

// Tracks the direction in which the elbow or knee of a captured limb points. A nearly straight limb
// does not define it: the direction then stays fixed relative to the limb.
class PoleTracker {
 public:
  // `otherwise`, of length 1, is the direction until a bent limb has defined one.
  Vec3d Follow(Vec3d start, Vec3d middle, Vec3d end, Vec3d otherwise);

 private:
  bool first_ = true;
  Vec3d along_, pole_;
};

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_LIMB_REACH_H_
