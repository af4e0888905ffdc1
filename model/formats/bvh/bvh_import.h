#ifndef DUET_MODEL_FORMATS_BVH_BVH_IMPORT_H_
#define DUET_MODEL_FORMATS_BVH_BVH_IMPORT_H_

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/motion/clip.h"
#include "model/retargeting/character.h"

namespace duet::formats::bvh {

struct BvhImportOptions : retargeting::CharacterOptions {
  // Which ROOT, in a file with several.
  int person = 0;
};

// Joint angles through forward kinematics to the skeleton's joint positions. A frame time that is a
// whole rate but for its rounding (0.0333333) counts as that rate.
//
// Errors: INVALID_ARGUMENT naming `source`: joints that cannot be mapped, a person of no possible
//         size.
absl::StatusOr<motion::Clip> FromBvh(const BvhDocument& document, absl::string_view source,
                                     const BvhImportOptions& options = {});

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_BVH_IMPORT_H_
