#ifndef DUET_CONTRIB_FORMATS_TESTS_FBX_TEXT_FBX_H_
#define DUET_CONTRIB_FORMATS_TESTS_FBX_TEXT_FBX_H_

#include <map>
#include <string>
#include <vector>

#include "model/motion/vec3.h"
#include "model/retargeting/affine.h"
#include "model/retargeting/rotation.h"

// FBX as text, with every part that the local transform of a node can have, and where its nodes are
// according to the FBX SDK.

namespace duet::test {

struct FbxBone {
  std::string name;
  int parent = -1;  // an earlier bone
  // The properties of the file that differ from their defaults: "PreRotation" in degrees, ...
  std::map<std::string, retargeting::Vec3d> properties;
  int rotation_order = 0;  // FbxEuler::EOrder: XYZ, XZY, YZX, YXZ, ZXY, ZYX
  int inherit_type = 1;    // FbxTransform::EInheritType: RrSs, RSrs, Rrs
};

// The keys of one property of one bone, one for each frame.
struct FbxTrack {
  int bone = 0;
  std::string property;  // "Lcl Rotation"
  std::vector<retargeting::Vec3d> keys;
};

struct FbxTake {
  std::string name;
  std::vector<FbxTrack> tracks;
  int first_frame = 0;
};

// A mesh with a triangle for each bone, bound to the bones where another take has them.
struct FbxSkin {
  FbxBone mesh;                // without a parent
  std::vector<FbxBone> bound;  // the bones as they were when the skin was bound
};

inline constexpr double kTextFbxRateHz = 30;

// Metres, y up, kTextFbxRateHz. `skin` may be null.
std::string TextFbx(const std::vector<FbxBone>& bones, const std::vector<FbxTake>& takes,
                    const FbxSkin* skin = nullptr);

// The places of the bones in a frame of a take. [bones]
std::vector<motion::Vec3> FbxWorld(const std::vector<FbxBone>& bones, const FbxTake& take,
                                   int frame);

// The joints of motion::SbuSkeleton as bones whose translations are those of `pose`.
std::vector<FbxBone> FbxPerson(const std::vector<motion::Vec3>& pose);

}  // namespace duet::test

#endif  // DUET_CONTRIB_FORMATS_TESTS_FBX_TEXT_FBX_H_
