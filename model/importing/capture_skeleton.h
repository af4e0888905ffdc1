#ifndef DUET_MODEL_IMPORTING_CAPTURE_SKELETON_H_
#define DUET_MODEL_IMPORTING_CAPTURE_SKELETON_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/body_part.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::importing {

// The skeleton that a data set gets.
struct CaptureSkeleton {
  motion::Skeleton skeleton;  // with hips and feet
  std::vector<motion::BodyPart> parts;
  motion::JointPair hands;
  std::string origin;              // where it was found
  std::vector<std::string> notes;  // what was assumed
};

struct SkeletonOptions {
  // "sbu" for the 15 joints of Duet's own models, or a file with the `skeleton` object of
  // dataset.json. Empty: as the capture has it.
  std::string skeleton;
  std::string root;         // the joint at the top; empty: found
  bool all_joints = false;  // fingers and face as well
};

// The skeleton of a capture. BVH: its hierarchy, without End Sites and joints that lie on their
// parents. CSV and JSON: the joints they name, joined to the tree whose bones are short and keep
// their length. SBU text and NPY: the 15 joints of SBU. What hangs on hands and head is left out.
// Joints are named in Duet's words where they are known (left_hip, left_foot, left_hand, neck), so
// that what goes by names works; otherwise by side and word (left_toe_base).
// Errors: INVALID_ARGUMENT naming the file, what could not be found, and the flag that says it.
absl::StatusOr<CaptureSkeleton> FindSkeleton(const std::filesystem::path& file,
                                             const SkeletonOptions& options);

// Bones for joints that have none: the tree over all joints that starts at `root` and whose bones
// are shortest and keep their lengths best. Limbs go by their joints' names (shoulder, elbow, hand;
// hip, knee, foot); no bone joins left to right.
std::vector<motion::Bone> FindBones(const std::vector<std::string>& joint_names,
                                    const motion::Poses& poses, int root);

}  // namespace duet::importing

#endif  // DUET_MODEL_IMPORTING_CAPTURE_SKELETON_H_
