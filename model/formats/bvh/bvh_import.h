#ifndef DUET_MODEL_FORMATS_BVH_BVH_IMPORT_H_
#define DUET_MODEL_FORMATS_BVH_BVH_IMPORT_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/motion/clip.h"
#include "model/motion/coordinates.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"

namespace duet::formats::bvh {

struct BvhImportOptions {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  retargeting::JointOverrides joint_overrides;
  // Absent: metres, centimetres, millimetres, inches or CMU's unit, whichever gives the way from
  // foot to hip to root the length of a person's (0.7 to 1.4 m).
  std::optional<double> metres_per_unit;
  // Absent: the axis along which the root stands above the feet.
  std::optional<motion::UpAxis> up_axis;
  // Which ROOT, in a file with several.
  int person = 0;
  std::vector<std::string>* notes = nullptr;  // may be null
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
