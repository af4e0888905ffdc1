#ifndef DUET_MODEL_MOTION_LIMB_LENGTHS_H_
#define DUET_MODEL_MOTION_LIMB_LENGTHS_H_

#include <vector>

#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::motion {

// The median length of every bone, in the order of skeleton.bones. Requires at least one frame.
// Shapes: positions [frames, joints]; returns [bones]. Units: those of positions.
std::vector<float> MedianBoneLengths(const Skeleton& skeleton, const std::vector<Vec3>& positions);

// Gives every bone its length in every frame and keeps its direction; the root stays where it is.
// A bone without a direction (its joints coincide) is left as it is.
// Shapes: lengths [bones]; positions [frames, joints].
void SetBoneLengths(const Skeleton& skeleton, const std::vector<float>& lengths,
                    std::vector<Vec3>* positions);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_LIMB_LENGTHS_H_
