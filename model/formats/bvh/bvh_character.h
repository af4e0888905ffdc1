#ifndef DUET_MODEL_FORMATS_BVH_BVH_CHARACTER_H_
#define DUET_MODEL_FORMATS_BVH_BVH_CHARACTER_H_

#include <vector>

#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_motion.h"
#include "model/retargeting/character_rig.h"

namespace duet::formats::bvh {

// Converts the rig of another format to BVH: keeps its names, hierarchy and bone lengths, y up, in
// units of `metres_per_unit`. Joints have the channels Zrotation, Xrotation and Yrotation; roots
// also have position channels.
//
// Shapes: poses [frames >= 1], of the rig's joints.
BvhDocument ToBvh(const retargeting::CharacterRig& rig,
                  const std::vector<retargeting::CharacterPose>& poses, double frame_rate_hz,
                  double metres_per_unit, const BvhKeys& keys);

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_BVH_CHARACTER_H_
