#ifndef DUET_MODEL_RETARGETING_MANNEQUIN_H_
#define DUET_MODEL_RETARGETING_MANNEQUIN_H_

#include <vector>

#include "model/motion/skeleton.h"
#include "model/retargeting/character_rig.h"
#include "model/retargeting/foot_pose.h"
#include "model/retargeting/mesh_builder.h"
#include "model/retargeting/rig.h"

namespace duet::retargeting {

// A body around a rig in its rest pose: a tapered limb on every bone, a ball on every joint, and,
// where joints have the names of motion::SbuSkeleton, chest, pelvis and a head, hands and feet.
struct Mannequin {
  SkinnedMesh body;
  SkinnedMesh visor;  // where the face is, in a dark colour; empty without a head
};

// `rest_positions` as of RestPositions(rig). The soles are `sole_depth` metres below the ankles, so
// that who stands in the motion stands on the floor.
Mannequin MakeMannequin(const motion::Skeleton& skeleton, const Rig& rig,
                        const std::vector<Vec3d>& rest_positions,
                        double sole_depth = kUsualAnkleHeight);

// A slender body of the bones of somebody else's rig, whatever its joints are called.
SkinnedMesh MakeStickFigure(const CharacterRig& rig);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_MANNEQUIN_H_
