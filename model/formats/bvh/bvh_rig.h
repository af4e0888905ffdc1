#ifndef DUET_MODEL_FORMATS_BVH_BVH_RIG_H_
#define DUET_MODEL_FORMATS_BVH_BVH_RIG_H_

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_import.h"
#include "model/formats/bvh/bvh_motion.h"
#include "model/motion/clip.h"
#include "model/retargeting/character_rig.h"

namespace duet::formats::bvh {

// Writes a clip of the joints of `options.skeleton` onto the rig of a BVH
// (retargeting::TransferToRig). Its names, hierarchy, offsets, channels and their order, unit and
// up axis are kept. Angles are continuous: of all equivalent angles, each frame has those nearest
// to the previous frame's.
//
// `options` select the rig and how to read its file; `source` denotes it in messages.
// Errors: INVALID_ARGUMENT for a rig that FromBvh or TransferToRig rejects, or a joint that must
//         rotate but has fewer than three rotation channels.
absl::StatusOr<BvhDocument> OntoBvhRig(const motion::Clip& clip, const BvhDocument& rig,
                                       absl::string_view source, const BvhImportOptions& options,
                                       const BvhKeys& keys = {});

// Checks that a BVH has a rig of a person. Errors: those of FromBvh, or of a rest pose.
absl::Status CheckBvhRig(const BvhDocument& document, absl::string_view source,
                         const BvhImportOptions& options);

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_BVH_RIG_H_
