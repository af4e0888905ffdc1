#ifndef DUET_MODEL_MOTION_FEET_H_
#define DUET_MODEL_MOTION_FEET_H_

#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::motion {

// The height of the lower foot in every frame. Shapes: returns [frames].
std::vector<float> LowerFoot(const JointPair& feet, const Poses& poses);

// The lowest height of either foot; infinity if there are no frames.
float LowestFoot(const JointPair& feet, const Poses& poses);

// The height of the floor under a motion: a low percentile of the heights of its lower foot, so
// that jumps and tracking errors do not change it. Requires a frame.
float FloorHeight(const JointPair& feet, const Poses& poses);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_FEET_H_
