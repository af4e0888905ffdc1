#ifndef DUET_MODEL_IMPORTING_CAPTURE_SKELETON_H_
#define DUET_MODEL_IMPORTING_CAPTURE_SKELETON_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/body_part.h"
#include "model/motion/skeleton.h"

namespace duet::importing {

// The skeleton of an imported data set.
struct CaptureSkeleton {
  motion::Skeleton skeleton;  // with hips and feet
  std::vector<motion::BodyPart> parts;
  motion::JointPair hands;
  std::string origin;              // its source
  std::vector<std::string> notes;  // the assumptions
};

struct SkeletonOptions {
  // "sbu" for the 15 joints of Duet's own models, or a file with the `skeleton` object of
  // dataset.json. If empty, the skeleton of the capture.
  std::string skeleton;
  std::string root;         // the root joint; inferred if empty
  bool all_joints = false;  // include fingers and face
};

// Finds the skeleton of a capture. BVH: its hierarchy, without End Sites and without joints at the
// position of their parent. SBU text, NPY, and CSV and JSON with their names: the 15 joints of SBU.
// Joints below hands and head are omitted. Known joints get Duet's names (left_hip, left_foot,
// left_hand, neck), on which other code relies; others are named by side and word (left_toe_base).
// Errors: INVALID_ARGUMENT naming the file, the missing item, and the flag that specifies it.
absl::StatusOr<CaptureSkeleton> FindSkeleton(const std::filesystem::path& file,
                                             const SkeletonOptions& options);

}  // namespace duet::importing

#endif  // DUET_MODEL_IMPORTING_CAPTURE_SKELETON_H_
