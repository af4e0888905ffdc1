#ifndef DUET_MODEL_RETARGETING_MANNEQUIN_H_
#define DUET_MODEL_RETARGETING_MANNEQUIN_H_

#include <vector>

#include "model/motion/skeleton.h"
#include "model/retargeting/character_rig.h"
#include "model/retargeting/foot_pose.h"
#include "model/retargeting/mesh_builder.h"
#include "model/retargeting/rig.h"

namespace duet::retargeting {

// A body around a rig in its rest pose: a tapered limb on every bone and a ball on every joint.
// Joints with the names of motion::SbuSkeleton also get a chest, pelvis, head, hands and feet.
struct Mannequin {
  SkinnedMesh body;
  SkinnedMesh visor;  // marks the face in a dark colour; empty without a head
};

// `rest_positions` is RestPositions(rig). The soles are `sole_depth` metres below the ankles, so
// that a person who stands in the motion stands on the floor.
Mannequin MakeMannequin(const motion::Skeleton& skeleton, const Rig& rig,
                        const std::vector<Vec3d>& rest_positions,
                        double sole_depth = kUsualAnkleHeight);

// A slender body around the bones of a user's rig, independent of its joint names.
SkinnedMesh MakeStickFigure(const CharacterRig& rig);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_MANNEQUIN_H_
