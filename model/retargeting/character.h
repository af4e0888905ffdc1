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
#include "model/retargeting/joint_tree.h"
#include "model/retargeting/reading_report.h"

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

// Checks that the joints that were found in a file make a body. `poses` are the skeleton's.
//
// Errors: INVALID_ARGUMENT naming `source` and the file's joints if both hips or both shoulders are
//         in one place in the whole motion: they are helpers with the names of joints.
absl::Status CheckBody(absl::string_view source, const motion::Skeleton& skeleton,
                       const motion::Poses& poses, const JointMap& map,
                       const std::vector<std::string>& file_joints);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_CHARACTER_H_
