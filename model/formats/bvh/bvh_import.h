#ifndef DUET_MODEL_FORMATS_BVH_BVH_IMPORT_H_
#define DUET_MODEL_FORMATS_BVH_BVH_IMPORT_H_

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/motion/clip.h"
#include "model/retargeting/character.h"

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

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_BVH_IMPORT_H_
