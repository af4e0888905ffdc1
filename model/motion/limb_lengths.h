#ifndef DUET_MODEL_MOTION_LIMB_LENGTHS_H_
#define DUET_MODEL_MOTION_LIMB_LENGTHS_H_

#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::motion {

// The median length of every bone, in the order of skeleton.bones. Requires at least one frame.
// Shapes: returns [bones]. Units: those of poses.
std::vector<float> MedianBoneLengths(const Skeleton& skeleton, const Poses& poses);

// Sets the length of every bone in every frame and keeps its direction; the root does not move. A
// bone without a direction (its joints coincide) is unchanged.
// Shapes: lengths [bones].
void SetBoneLengths(const Skeleton& skeleton, const std::vector<float>& lengths, Poses* poses);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_LIMB_LENGTHS_H_
