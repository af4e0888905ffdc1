#ifndef DUET_TESTS_FORMATS_BVH_RIG_FAMILIES_H_
#define DUET_TESTS_FORMATS_BVH_RIG_FAMILIES_H_

#include <string>
#include <vector>

#include "model/formats/bvh/bvh_document.h"

namespace duet::test {

// A rig as programs write them, made from the names that they use.
struct RigFamily {
  std::string name;
  formats::bvh::BvhDocument document;  // one frame, standing at rest
};

// CMU (cgspeed), Mixamo, 3ds Max Biped, Rokoko, Xsens, OptiTrack, Unreal's mannequin, Rigify, VRM
// (Unity's humanoid), SMPL and Kinect: their names, hierarchies, channel orders, units, up axes and
// the kinds of rest pose that go with them (arms out, sloping or hanging).
std::vector<RigFamily> RigFamilies();

}  // namespace duet::test

#endif  // DUET_TESTS_FORMATS_BVH_RIG_FAMILIES_H_
