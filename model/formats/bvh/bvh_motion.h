#ifndef DUET_MODEL_FORMATS_BVH_BVH_MOTION_H_
#define DUET_MODEL_FORMATS_BVH_BVH_MOTION_H_

#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/character.h"
#include "model/retargeting/rotation.h"

// Converts between the motions of people and BVH documents.

namespace duet::formats::bvh {

struct BvhImportOptions : retargeting::CharacterOptions {
  // The index of the ROOT, in a file with several.
  int person = 0;
};

// Converts joint angles to the skeleton's joint positions by forward kinematics. A frame time that
// is a rounded reciprocal of an integer rate (0.0333333) is read as that rate.
//
// Errors: INVALID_ARGUMENT naming `source` if joints cannot be mapped or the person has no size.
absl::StatusOr<motion::Clip> FromBvh(const BvhDocument& document, absl::string_view source,
                                     const BvhImportOptions& options = {});

// Converts one person to joint angles in units of `metres_per_unit` (0.01: centimetres, which
// animation tools assume), y up, in the clip's world, with the rest pose of MakeRig. The root has
// six channels, every other joint three. Rotations apply as Rz Rx Ry. Angles are continuous from
// frame to frame. If bone lengths are constant, positions are exact; otherwise a joint is off by
// the sum of the differences between the bones from the root to the joint and their medians.
//
// Requires a clip of the skeleton's joints that CheckClip accepts.
BvhDocument ToBvh(const motion::Clip& clip, const motion::Skeleton& skeleton,
                  double metres_per_unit = 0.01);

// Writes a clip of the joints of `options.skeleton` onto the rig of a BVH
// (retargeting::TransferToRig). Its names, hierarchy, offsets, channels and their order, unit and
// up axis are kept. Angles are continuous: of all equivalent angles, each frame has those nearest
// to the previous frame's.
//
// `options` select the rig and how to read its file; `source` denotes it in messages.
// Errors: INVALID_ARGUMENT for a rig that FromBvh or TransferToRig rejects, or a joint that must
//         rotate but has fewer than three rotation channels.
absl::StatusOr<BvhDocument> OntoBvhRig(const motion::Clip& clip, const BvhDocument& rig,
                                       absl::string_view source, const BvhImportOptions& options);

// The motion of a joint: the values of its rotation and position channels; empty if it has none.
struct BvhTrack {
  std::vector<retargeting::Quaternion> turns;  // [frames], in the parent's axes
  std::vector<retargeting::Vec3d> places;      // [frames], in the file's unit
};

// Writes the motion into `document`: its frames, frame time and values. Angles are continuous: of
// all equivalent angles, each frame has those nearest to the previous frame's.
//
// Shapes: tracks [document->joints], with the same number of frames, at least one. Joints without
// rotation channels about three axes stay at zero.
void WriteMotion(const std::vector<BvhTrack>& tracks, double frame_rate_hz, BvhDocument* document);

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_BVH_MOTION_H_
