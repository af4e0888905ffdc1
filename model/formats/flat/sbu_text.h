#ifndef DUET_MODEL_FORMATS_FLAT_SBU_TEXT_H_
#define DUET_MODEL_FORMATS_FLAT_SBU_TEXT_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/coordinates.h"
#include "model/motion/sbu.h"
#include "model/motion/skeleton.h"

namespace duet::formats::flat {

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

#endif  // DUET_MODEL_FORMATS_FLAT_SBU_TEXT_H_
