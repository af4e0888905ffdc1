#ifndef DUET_MODEL_RETARGETING_JOINT_MAPPING_H_
#define DUET_MODEL_RETARGETING_JOINT_MAPPING_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"
#include "model/retargeting/reading_report.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// The joints of a file with a hierarchy, independent of any motion.
struct JointTree {
  std::vector<std::string> names;
  std::vector<int> parents;    // [names], an earlier joint; -1 for a root
  std::vector<Vec3d> offsets;  // [names], from the parent and in its axes, in any unit
};

// `parents` are those of joints, -1 for a root.
bool IsAtOrBelow(const std::vector<int>& parents, int joint, int ancestor);
// The nearest common ancestor of `a` and `b`, which may be one of them; -1 if there is none.
int CommonAncestor(const std::vector<int>& parents, int a, int b);

// Joints that the user specifies: skeleton joint -> joint of the file. They override every rule.
using JointOverrides = std::map<std::string, std::string>;

// One joint of a skeleton as a weighted mean of joints of a file.
struct JointSource {
  struct Term {
    int joint = 0;
    float weight = 1;
  };
  std::vector<Term> terms;
};

// The source in a file of each of a skeleton's joints.
struct JointMap {
  std::vector<JointSource> sources;  // [skeleton joints]
  // If the file has a hierarchy: the straightened character, whose trunk is upright along y with
  // the summed length of its bones, arms stretched to the sides, legs hanging. [skeleton joints]
  std::vector<motion::Vec3> straight;
};

// What happens if a file has no joint for a skeleton's toes, the joints beyond its feet.
enum class MissingToes {
  kRejected,
  kAtTheFeet  // They are placed at the feet, as on a rig whose legs end there.
};

// Finds a skeleton's joints in a file by name (docs/formats.md has the table). If the file has all
// of the skeleton's names, they are used unchanged. Otherwise names are compared without prefix
// (`mixamorig:`, `Bip01`), case, separators and side (`LeftArm`, `arm.L`, `lArm`). Neck and torso
// are chosen by position along the trunk: the neck joint nearest to half way between the shoulders,
// and the spine joint nearest to half way from hips to neck. A head joint at the base of the skull
// is raised to the middle of the head.
//
// Only the hierarchy decides, so that all clips of one rig map alike.
//
// Errors: INVALID_ARGUMENT naming `source`, the skeleton's joints without a source, the names that
//         the file has, or an override that names no joint of the skeleton or of the file.
//
// If `readings` is not null, it receives the source of every joint of the skeleton, even if some
// are missing.
absl::StatusOr<JointMap> MapJoints(absl::string_view source, const JointTree& tree,
                                   const motion::Skeleton& skeleton,
                                   const JointOverrides& overrides = {},
                                   std::vector<JointReading>* readings = nullptr,
                                   MissingToes missing_toes = MissingToes::kRejected);

// The same for a file without a hierarchy: neck and torso are chosen by mean distances over the
// motion.
//
// Shapes: poses [frames >= 1, names], in any unit.
absl::StatusOr<JointMap> MapJoints(absl::string_view source, const std::vector<std::string>& names,
                                   const motion::Poses& poses, const motion::Skeleton& skeleton,
                                   const JointOverrides& overrides = {},
                                   std::vector<JointReading>* readings = nullptr);

// Converts one frame of the file's joints to the skeleton's. [names] -> [skeleton joints]
std::vector<motion::Vec3> ApplyJointMap(const JointMap& map, absl::Span<const motion::Vec3> pose);

// Parses a user's table of joints, one per line:
//
//   # model joint = joint of the file
//   left_hand = LeftWrist
//   torso = Chest 3
//
// '#' at the beginning of a line starts a comment; white space around names is ignored.
//
// Errors: INVALID_ARGUMENT "source:line: ..." for any other line or a repeated joint.
absl::StatusOr<JointOverrides> ParseJointTable(absl::string_view text, absl::string_view source);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_JOINT_MAPPING_H_
