#ifndef DUET_MODEL_IMPORTING_CAPTURE_H_
#define DUET_MODEL_IMPORTING_CAPTURE_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
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
  std::optional<double> frame_rate_hz;  // overrides the files' own
  // Receives one note for each choice between several joints. May be null.
  std::vector<std::string>* notes = nullptr;
};

// Reads both people. Formats with a hierarchy (BVH, glTF) keep the file's unit and axes. Every
// other format is read in the coordinates that the file states; the default is metres, y up.
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
