#ifndef DUET_MODEL_RETARGETING_CHARACTER_H_
#define DUET_MODEL_RETARGETING_CHARACTER_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/coordinates.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"
#include "model/retargeting/joint_tree.h"
#include "model/retargeting/reading_report.h"

namespace duet::retargeting {

// A character of a file with a hierarchy, and how it moves, in the file's own unit and axes.
struct Character {
  JointTree tree;
  int frame_count = 0;  // at least one
  double frame_rate_hz = 0;
  // Where the joints are in one frame. [tree.names]
  std::function<std::vector<motion::Vec3>(int frame)> pose;
  // Metres in one unit as the file states it, and where it does. Absent for most files.
  std::optional<double> stated_metres_per_unit;
  std::string stated_by;
};

// How a character was understood.
struct CharacterFit {
  double metres_per_unit = 1;
  motion::UpAxis up_axis = motion::UpAxis::kYUp;
  JointMap joints;  // on the character's tree
};

// What the reader of a file with a hierarchy is told beside it.
struct CharacterOptions {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  JointOverrides joint_overrides;
  // Absent: the unit that the file states, centimetres, metres, millimetres, inches, CMU's unit or
  // decimetres, whichever is the first to give the way from foot to hip to root the length of a
  // person's (0.7 to 1.4 m). Where none does, that way is taken as 1 m. A warning among the notes
  // says so, and also where the person is then smaller or taller than people are.
  std::optional<double> metres_per_unit;
  // Absent: the axis along which the root stands above the feet.
  std::optional<motion::UpAxis> up_axis;
  std::vector<std::string>* notes = nullptr;  // receives what was decided; may be null
  ReadingReport* report = nullptr;            // the same with all its details; may be null
  CharacterFit* fit = nullptr;                // receives the same as values; may be null
};

// A character's motion as the skeleton's joints in metres, y up.
//
// Errors: INVALID_ARGUMENT naming `source`: joints that cannot be mapped, a character of no size.
absl::StatusOr<motion::Clip> ToClip(const Character& character, absl::string_view source,
                                    const CharacterOptions& options);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_CHARACTER_H_
