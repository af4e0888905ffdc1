#ifndef DUET_MODEL_FORMATS_FLAT_FLAT_FILES_H_
#define DUET_MODEL_FORMATS_FLAT_FLAT_FILES_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/coordinates.h"
#include "model/motion/joint_rotations.h"
#include "model/motion/recorded_motion.h"
#include "model/motion/sbu.h"
#include "model/motion/skeleton.h"

// Files that hold joint positions as they are.

namespace duet::formats::flat {

// Positions by column, one row per frame, for scripts and spreadsheets:
//
//   # duet motion: frame_rate_hz=30 unit=metres up_axis=y-up
//   frame,leader.head_x,leader.head_y,leader.head_z,...,follower.head_x,...
//   0,0.01,1.62,-0.3,...
//
// A file of one person has columns without `leader.` and `follower.`. Comment lines start with '#';
// of their words, only frame_rate_hz (or fps), unit and up_axis (motion/coordinates.h) are read.
// The three columns of a joint are side by side; `frame` and `time` before them are ignored.
//
// Errors: INVALID_ARGUMENT "source:line: column 4: expected ..., got ...".
absl::StatusOr<motion::RecordedMotion> ParseCsv(absl::string_view text, absl::string_view source);

// Writes metres, y up. Requires one person, or a leader and a follower, whom CheckPeople accepts.
std::string FormatCsv(const std::vector<motion::Clip>& people);

// One JSON document:
//
//   {"format": "duet-motion", "version": 1, "frame_rate_hz": 30, "unit": "metres",
//    "up_axis": "y-up",
//    "joint_names": ["head", ...], "bones": [[1, 0], ...],
//    "leader": [[[x, y, z], ... joints], ... frames], "follower": [...]}
//
// To read it, joint_names and leader are required and follower is optional. The other fields have
// the same defaults as in CSV. Unknown fields are ignored. bones (parent and child as indices into
// joint_names) are for other programs.
//
// Errors: INVALID_ARGUMENT naming `source`, the field, the expected value and the actual one.
absl::StatusOr<motion::RecordedMotion> ParseJsonMotion(absl::string_view text,
                                                       absl::string_view source);

// Writes metres, y up. Requires one person, or a leader and a follower, whom CheckPeople accepts.
//
// `rotations` of the follower may be null; they add the fields
//   "rig": [{"name": "torso", "parent": -1, "offset": [x, y, z], "joint": 2}, ...],
//   "rotations": [[[x, y, z, w], ... rig joints], ... frames]
// with the meaning of docs/rotations.md. ParseJsonMotion ignores them.
std::string FormatJsonMotion(const std::vector<motion::Clip>& people,
                             const motion::Skeleton& skeleton,
                             const motion::JointRotations* rotations = nullptr);

// Parses NumPy's array file: float32 or float64, little-endian, C order, [frames, joints, 3] or
// [people, frames, joints, 3] with one or two people. The file holds neither joint names nor a
// frame rate: the joints are `joint_names` in their order, and the returned rate is 0.
//
// Source: the .npy format, versions 1.0 to 3.0 (numpy.lib.format).
// Errors: INVALID_ARGUMENT naming `source`, the expected value and the actual one.
absl::StatusOr<motion::RecordedMotion> ParseNpy(absl::string_view bytes, absl::string_view source,
                                                const std::vector<std::string>& joint_names);

// Writes float32 [2, frames, joints, 3], leader first, or [frames, joints, 3] for one person.
// Requires people whom CheckPeople accepts.
std::string FormatNpy(const std::vector<motion::Clip>& people);

// The properties that the text does not state. The defaults are those of SBU Kinect Interaction;
// K3HI differs only in its frame rate (30).
struct SbuOptions {
  std::vector<std::string> joint_names = motion::SbuSkeleton().joint_names;
  double frame_rate_hz = motion::kSbuFrameRateHz;
  motion::Coordinates coordinates = {motion::LengthUnit::kSbuNormalised, motion::UpAxis::kYDown};
};

// The two people of a file, by their place in the image. The file does not state who leads.
struct SbuRecording {
  motion::Clip left;
  motion::Clip right;
};

// Parses `skeleton_pos.txt` and every file with its line layout: a frame number, joints x 3 values
// of the person on the left, then those of the person on the right, all separated by commas.
//
// Shapes: both clips [frames >= 1, joint_names].
// Units:  the text in options.coordinates; the clips in world metres, y up.
// Errors: INVALID_ARGUMENT naming source, line and column, for a wrong number of values in a line,
//         a value that is not a finite number, frame numbers that do not increase by a constant
//         step, or an empty text.
absl::StatusOr<SbuRecording> ParseSbu(absl::string_view text, absl::string_view source,
                                      const SbuOptions& options = {});
absl::StatusOr<SbuRecording> ReadSbu(const std::filesystem::path& path,
                                     const SbuOptions& options = {});

// Writes the same layout, with frame numbers from 1. Requires the same joints and frames of both
// clips.
absl::StatusOr<std::string> FormatSbu(const SbuRecording& recording,
                                      const SbuOptions& options = {});

}  // namespace duet::formats::flat

#endif  // DUET_MODEL_FORMATS_FLAT_FLAT_FILES_H_
