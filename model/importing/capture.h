#ifndef DUET_MODEL_IMPORTING_CAPTURE_H_
#define DUET_MODEL_IMPORTING_CAPTURE_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/formats/research/layout.h"
#include "model/importing/pairing.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"

namespace duet::importing {

// A pair that has been read.
struct Capture {
  PairFiles files;
  motion::Clip first;  // of the data set's joints
  motion::Clip second;
};

struct CaptureOptions {
  motion::Skeleton skeleton;
  retargeting::JointOverrides joint_overrides;
  std::optional<double> frame_rate_hz;              // overrides the files' own
  std::optional<formats::research::Layout> layout;  // of .npy
  std::filesystem::path body_model;                 // of .npz
  bool unit_is_given = false;                       // ignore the unit that a file states
  bool up_axis_is_given = false;                    // ignore the up axis that a file states
  // Receives one note for each choice between several joints. May be null.
  std::vector<std::string>* notes = nullptr;
};

// Reads both people. Formats with a hierarchy (BVH, glTF, ASF) keep the file's unit and axes,
// except that a unit which an ASF file states is converted to metres. FBX is read in metres, y up,
// as the file states its unit and axes. Every other format is read in the coordinates that the file
// states; the default is metres, y up.
//
// Errors: INVALID_ARGUMENT naming the file, also if a file that must hold two people holds one.
absl::StatusOr<Capture> ReadCapture(const std::filesystem::path& folder, const PairFiles& files,
                                    const CaptureOptions& options);

// Resamples both people to one rate and truncates the longer one. Returns their difference in
// length, seconds.
double Align(double rate_hz, Capture* capture);

// INVALID_ARGUMENT unless these can be two people in one place, in metres, y up: with legs of a
// person's length, and at a plausible distance from each other.
absl::Status CheckPlausible(const Capture& capture, const motion::Skeleton& skeleton);

// Cuts a capture into equal pieces of at most `longest` frames.
std::vector<Capture> Cut(const Capture& capture, int longest);

}  // namespace duet::importing

#endif  // DUET_MODEL_IMPORTING_CAPTURE_H_
