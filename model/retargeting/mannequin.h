#ifndef DUET_MODEL_RETARGETING_MANNEQUIN_H_
#define DUET_MODEL_RETARGETING_MANNEQUIN_H_

#include <cstdint>
#include <vector>

#include "model/motion/skeleton.h"
#include "model/retargeting/rig.h"

namespace duet::retargeting {

// A surface of triangles; every vertex goes with one joint of a rig.
struct SkinnedMesh {
  std::vector<Vec3d> positions;   // [vertices], metres, of the rest pose
  std::vector<Vec3d> normals;     // [vertices], of length 1, outwards
  std::vector<int> joints;        // [vertices], rig joints
  std::vector<uint32_t> indices;  // three a triangle, counterclockwise from outside
};

// A body around a rig in its rest pose: a tapered limb on every bone, a ball on every joint, and,
// where joints have the names of motion::SbuSkeleton, chest, pelvis and a head, hands and feet.
struct Mannequin {
  SkinnedMesh body;
  SkinnedMesh visor;  // where the face is, in a dark colour; empty without a head
};

// `rest_positions` as of RestPositions(rig).
Mannequin MakeMannequin(const motion::Skeleton& skeleton, const Rig& rig,
                        const std::vector<Vec3d>& rest_positions);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_MANNEQUIN_H_
