#ifndef DUET_MODEL_RETARGETING_CHARACTER_H_
#define DUET_MODEL_RETARGETING_CHARACTER_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/coordinates.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"
#include "model/retargeting/reading_report.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// A character of a file with a hierarchy and its motion, in the file's own unit and axes.
struct Character {
  JointTree tree;
  int frame_count = 0;  // at least one
  double frame_rate_hz = 0;
  // The positions of the joints in one frame. [tree.names]
  std::function<std::vector<motion::Vec3>(int frame)> pose;
};

// The unit, axis and joints that were used to read a character.
struct CharacterFit {
  double metres_per_unit = 1;
  motion::UpAxis up_axis = motion::UpAxis::kYUp;
  JointMap joints;  // on the character's tree
};

// Options for reading a file with a hierarchy.
struct CharacterOptions {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  JointOverrides joint_overrides;
  MissingToes missing_toes = MissingToes::kRejected;
  // If absent, the unit that motion::InferUnit returns. If there is none, legs are taken as 1 m
  // long, with a warning.
  std::optional<double> metres_per_unit;
  // If absent, the axis that motion::InferUpAxis returns; if there is none, y, with a warning.
  std::optional<motion::UpAxis> up_axis;
  ReadingReport* report = nullptr;  // receives the decisions; may be null
  CharacterFit* fit = nullptr;      // receives them as values; may be null
};

// INVALID_ARGUMENT unless a file's unit may have this length.
absl::Status CheckMetresPerUnit(double metres);

// Converts a character's motion to the skeleton's joints in metres, y up.
//
// Errors: INVALID_ARGUMENT naming `source` if joints cannot be mapped or the character has no size.
absl::StatusOr<motion::Clip> ToClip(const Character& character, absl::string_view source,
                                    const CharacterOptions& options);

// Checks that the joints that were found in a file make a body. `poses` are the skeleton's; the
// body is at least as large as `least_size`, in their unit.
//
// Errors: INVALID_ARGUMENT naming `source` and the file's joints if both hips or both shoulders are
//         in one place in the whole motion: they are helpers with the names of joints.
absl::Status CheckBody(absl::string_view source, const motion::Skeleton& skeleton,
                       const motion::Poses& poses, const JointMap& map,
                       const std::vector<std::string>& file_joints, double least_size = 0);

// The user's rig in its rest pose, as read from a file: the target of a motion transfer.
//
// Units: metres, y up, in the world.
struct CharacterRig {
  std::vector<std::string> names;
  std::vector<int> parents;      // [names], an earlier joint; -1 for the root
  std::vector<Vec3d> positions;  // [names]
  // Joints that a file of the rig may translate in every frame, at least the root.
  std::vector<bool> moves;  // [names]
  // Maps the rig's joints to the skeleton's.
  JointMap joints;
};

// One frame on a rig: the rotation of every joint from the rest pose, in world axes (an undriven
// joint has its parent's rotation), and its position.
struct CharacterPose {
  std::vector<Quaternion> turns;  // [names]
  std::vector<Vec3d> positions;   // [names]
};

// Returns the frame of a rig's motion that replaces its rest pose, because the rest pose is no
// standing person: the frame in which the person stands most upright. Absent if the rest pose is a
// standing person, or the motion's joints are not a person's.
//
// `rig` is at rest; `read` is its motion, with the joints that rig.joints gives.
// Errors: INVALID_ARGUMENT naming `source` if there is no such frame either.
absl::StatusOr<std::optional<int>> FindRestFrame(const CharacterRig& rig, const motion::Clip& read,
                                                 absl::string_view source);

// The rotation from a file's axes to the world's.
Quaternion ToWorldAxes(motion::UpAxis up_axis);

// The rig of a file whose joints have no rotation at rest (BVH): the tree's offsets define the
// rest positions, with roots at the origin, unless `positions` of the tree's joints in the file's
// unit and axes do. Only roots are translated.
//
// `fit` is the result of ToClip for the same tree.
CharacterRig RestRig(const JointTree& tree, const CharacterFit& fit,
                     const std::vector<Vec3d>& positions = {});

// The joints of a clip in their roles, for any skeleton whose joints are named as in
// docs/formats.md. "left_hand" and "left_foot" of the body are the wrist and the ankle.
struct BodyRoles {
  JointMap body;  // motion::SbuSkeleton's joints from those of the clip
  // Joints beyond the ankles and beyond the wrists; a skeleton may lack them.
  std::optional<motion::JointPair> toes, hands;
};

// Errors: INVALID_ARGUMENT naming `field` and the joints that no name gives.
absl::StatusOr<BodyRoles> FindBodyRoles(absl::string_view field, const motion::Clip& clip);

// Maps through two maps: `first` gives the joints that `second` reads.
JointMap Compose(const JointMap& first, const JointMap& second);

// Transfers a clip of any skeleton of a person (FindBodyRoles) to a user's rig with any rest pose,
// names and extra joints. The rig's bones keep their lengths.
//
// - Kabsch's fit over hips, shoulders and trunk rotates pelvis and chest. The spine's joints share
//   the rotation between the two; neck and head share that of the head.
// - Two-bone inverse kinematics places feet and hands at the clip's ankles and wrists, as far as
//   the limbs reach, with elbows and knees on the clip's side. The pelvis height follows from the
//   length of the rig's legs; the pelvis is lowered if a leg would not reach.
// - The plane of the elbow or knee twists both bones of a limb. Standing feet are level.
// - If the clip has toes, feet point at them, and the rig's toes stay level on the floor while a
//   heel is up. If it has hands beyond the wrists, hands point at them; otherwise they keep their
//   rotation relative to the forearm.
// - Collar bones, fingers and all other joints keep their rest pose relative to their parents.
//
// Requires a rig whose joints map to the clip's. Shapes: returns [frames].
// Errors: INVALID_ARGUMENT naming `source` for a rig that lacks its own hips, knees, feet,
//         shoulders, elbows or hands, or whose limbs have no length; naming the follower if its
//         joints are not those of a person.
absl::StatusOr<std::vector<CharacterPose>> TransferToRig(const motion::Clip& clip,
                                                         const CharacterRig& rig,
                                                         absl::string_view source);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_CHARACTER_H_
