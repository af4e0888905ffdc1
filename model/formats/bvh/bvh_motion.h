#ifndef DUET_MODEL_FORMATS_BVH_BVH_MOTION_H_
#define DUET_MODEL_FORMATS_BVH_BVH_MOTION_H_

#include <optional>
#include <string>
#include <vector>

#include "model/formats/bvh/bvh_document.h"
#include "model/retargeting/euler.h"
#include "model/retargeting/rotation.h"

// Turns and places of joints as the channels of a BVH have them.

namespace duet::formats::bvh {

// How a joint moves: what its rotation and position channels say. Empty where it has none of them.
struct BvhTrack {
  std::vector<retargeting::Quaternion> turns;  // [frames], in the parent's axes
  std::vector<retargeting::Vec3d> places;      // [frames], in the file's unit
};

inline constexpr int kMostKeysPerFrame = 16;

struct BvhKeys {
  // Keys written for each frame of the motion, 1 to kMostKeysPerFrame: the file's rate is that many
  // times the motion's. Between frames joints turn evenly, the shortest way.
  int per_frame = 1;
  // Receives what is worth telling: a joint near gimbal lock that programs which draw straight
  // lines between angles show elsewhere, and how many keys a frame would do. May be null.
  std::vector<std::string>* notes = nullptr;
};

// The order of a joint's three rotation channels; absent where they are not three about three axes.
std::optional<retargeting::EulerOrder> RotationOrder(const BvhJoint& joint);

// Writes the motion into `document`: its frames, frame time and values. Angles are continuous (of
// those that mean the same, each frame has the nearest to the last one's).
//
// Shapes: tracks [document->joints], alike in frames, one at least. Joints without a RotationOrder
// stay at zero.
void WriteMotion(const std::vector<BvhTrack>& tracks, double frame_rate_hz, const BvhKeys& keys,
                 BvhDocument* document);

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_BVH_MOTION_H_
