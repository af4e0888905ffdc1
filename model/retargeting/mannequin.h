#ifndef DUET_MODEL_RETARGETING_MANNEQUIN_H_
#define DUET_MODEL_RETARGETING_MANNEQUIN_H_

#include <cmath>
#include <cstdint>
#include <vector>

#include "model/motion/skeleton.h"
#include "model/retargeting/foot_pose.h"
#include "model/retargeting/rig_fitting.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// An sRGB colour, 0 to 255.
struct Colour {
  int red = 0, green = 0, blue = 0;
};

// The look of the mannequins in every file and on the page (client/viewer).
struct Look {
  Colour colour;
  double roughness = 0;
};
inline constexpr Look kLeaderLook = {{0xf0, 0xa0, 0x4b}, 0.62},
                      kFollowerLook = {{0x4f, 0xb3, 0xbf}, 0.62},
                      kVisorLook = {{0x1b, 0x1d, 0x22}, 0.25};

// Converts a channel of an sRGB colour to linear light, 0 to 1, as renderers need it.
inline double Linear(int channel) {
  const double share = channel / 255.0;
  return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

// A surface of triangles; every vertex follows one joint of a rig.
struct SkinnedMesh {
  std::vector<Vec3d> positions;   // [vertices], metres, of the rest pose
  std::vector<Vec3d> normals;     // [vertices], of length 1, outwards
  std::vector<int> joints;        // [vertices], rig joints
  std::vector<uint32_t> indices;  // three per triangle, counterclockwise from outside
};

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

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_MANNEQUIN_H_
