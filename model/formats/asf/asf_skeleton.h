#ifndef DUET_MODEL_FORMATS_ASF_ASF_SKELETON_H_
#define DUET_MODEL_FORMATS_ASF_ASF_SKELETON_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/retargeting/rotation.h"

namespace duet::formats::asf {

// The translation or rotation that one number of a bone's motion sets.
enum class AsfFreedom { kTx, kTy, kTz, kRx, kRy, kRz };

// A bone, from the joint where it starts to the one where it ends.
struct AsfBone {
  std::string name;
  int parent = -1;                   // an earlier bone; -1 for the root, which is the first
  retargeting::Vec3d extent;         // from start to end at rest, in the world's axes
  retargeting::Quaternion axes;      // of its rotations, in world axes
  std::vector<AsfFreedom> freedoms;  // in the order of the motion's values; only the root moves
};

// The skeleton of an .asf file. Lengths are in the file's unit. `radians`: whether the angles of
// its motions are in radians, not in degrees.
//
// `units_per_inch` is the value of ":units length": CMU's 0.45 means 0.45 units per inch.
struct AsfSkeleton {
  std::vector<AsfBone> bones;   // parents first
  retargeting::Vec3d position;  // of the root at rest
  bool radians = false;
  std::optional<double> units_per_inch;

  // Returns -1 if no bone has this name.
  int Find(absl::string_view name) const;
};

// Errors: INVALID_ARGUMENT "source:line: ...: expected ..., got ..."; also if the bones are not a
//         tree below the root.
absl::StatusOr<AsfSkeleton> ParseAsf(absl::string_view text, absl::string_view source);

// Returns the product of rotations about these axes. The first axis applies first.
//
// angles: [axes], radians
retargeting::Quaternion TurnInOrder(const std::vector<AsfFreedom>& axes,
                                    const std::vector<double>& angles);

}  // namespace duet::formats::asf

#endif  // DUET_MODEL_FORMATS_ASF_ASF_SKELETON_H_
