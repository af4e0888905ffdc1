#ifndef DUET_MODEL_RETARGETING_LIMB_REACH_H_
#define DUET_MODEL_RETARGETING_LIMB_REACH_H_

#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// How a limb of two bones stands so that its end is at a target.
struct LimbPose {
  Vec3d upper, lower;  // the way that either bone goes, of length 1
  // About which the joint between them bends, of length 1: across both bones, so that the lower one
  // comes from the upper one by a turn about it.
  Vec3d hinge;
};

// From `start` to `target`, or as near as the bones reach. `pole`, of length 1, is the side to
// which elbow or knee go out.
LimbPose ReachFor(Vec3d start, Vec3d target, double upper_length, double lower_length, Vec3d pole);

// Follows on which side elbow or knee of a captured limb are. A limb that is nearly straight does
// not say: there the side stays as it was on the limb.
class PoleTracker {
 public:
  // `otherwise`: the side while nothing has been said, of length 1.
  Vec3d Follow(Vec3d start, Vec3d middle, Vec3d end, Vec3d otherwise);

 private:
  bool first_ = true;
  Vec3d along_, pole_;
};

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_LIMB_REACH_H_
