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

// A clip of motion::SbuSkeleton's joints on the rig of a BVH: its names, hierarchy, offsets,
// channels with their orders, unit and up axis (retargeting::TransferToRig). Angles are continuous:
// of the angles that mean the same, each frame has those nearest to the last one's.
//
// `options` say how the rig's file is read and whose rig is taken; `source` is how errors call it.
// Errors: INVALID_ARGUMENT for a rig that FromBvh does not read or TransferToRig refuses, or a
// joint that
//         has to turn and has not three rotation channels.
absl::StatusOr<BvhDocument> OntoBvhRig(const motion::Clip& clip, const BvhDocument& rig,
                                       absl::string_view source, const BvhImportOptions& options,
                                       const BvhKeys& keys = {});

// The rig of a person of a BVH, for writing in another format. Errors: those of FromBvh.
absl::StatusOr<retargeting::CharacterRig> BvhRig(const BvhDocument& document,
                                                 absl::string_view source,
                                                 const BvhImportOptions& options);

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_BVH_RIG_H_
