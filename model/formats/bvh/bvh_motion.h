#ifndef DUET_MODEL_FORMATS_BVH_BVH_MOTION_H_
#define DUET_MODEL_FORMATS_BVH_BVH_MOTION_H_

#include <optional>
#include <string>
#include <vector>

#include "model/formats/bvh/bvh_document.h"
#include "model/retargeting/euler.h"
#include "model/retargeting/rotation.h"

// Converts rotations and positions of joints to the channels of a BVH.

namespace duet::formats::bvh {

// The motion of a joint: the values of its rotation and position channels; empty if it has none.
struct BvhTrack {
  std::vector<retargeting::Quaternion> turns;  // [frames], in the parent's axes
  std::vector<retargeting::Vec3d> places;      // [frames], in the file's unit
};

inline constexpr int kMostKeysPerFrame = 16;

struct BvhKeys {
  // Keys per frame of the motion, 1 to kMostKeysPerFrame. The file's rate is this multiple of the
  // motion's. Between frames joints rotate at constant speed along the shortest arc.
  int per_frame = 1;
  // Receives a note if linear interpolation of angles is visibly wrong for a joint near gimbal
  // lock, with the number of keys per frame that prevents it. May be null.
  std::vector<std::string>* notes = nullptr;
};

// The order of a joint's rotation channels; absent unless it has one about each of three axes.
std::optional<retargeting::EulerOrder> RotationOrder(const BvhJoint& joint);

// Writes the motion into `document`: its frames, frame time and values. Angles are continuous: of
// all equivalent angles, each frame has those nearest to the previous frame's.
//
// Shapes: tracks [document->joints], with the same number of frames, at least one. Joints without a
// RotationOrder stay at zero.
void WriteMotion(const std::vector<BvhTrack>& tracks, double frame_rate_hz, const BvhKeys& keys,
                 BvhDocument* document);

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_BVH_MOTION_H_
