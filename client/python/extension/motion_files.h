#ifndef DUET_CLIENT_PYTHON_EXTENSION_MOTION_FILES_H_
#define DUET_CLIENT_PYTHON_EXTENSION_MOTION_FILES_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/motion/clip.h"
#include "model/motion/vertical.h"
#include "model/retargeting/joint_mapping.h"

// Reads and writes motion files like `duet convert`, and estimates the vertical like `duet
// inspect`, for the Python package. Nothing here uses Python. All functions are safe to call
// concurrently.

namespace duet::client::python::extension {

// The arguments of duet_motion.read_motion. An empty string or an absent number: as the file says.
struct ReadArguments {
  std::string side;  // "left", "right"; empty: all people
  std::optional<double> frame_rate_hz;
  std::string unit;
  std::string up_axis;
  std::optional<double> metres_per_unit;
  retargeting::JointOverrides joint_map;
  std::optional<double> resample_hz;
  std::string layout;
  std::string body_model;
};

// Reads one person or two, in metres, y up, in the joints of Duet's skeleton.
//
// Errors: those of `duet convert`, with the names of arguments instead of flags.
absl::StatusOr<std::vector<motion::Clip>> ReadMotion(const std::filesystem::path& file,
                                                     const ReadArguments& arguments);

// Writes the people of a "duet-motion" JSON document (docs/formats.md) in the format of the file's
// extension.
//
// Errors: those of `duet convert`.
absl::Status WriteMotion(const std::string& document, const std::filesystem::path& file);

// Estimates the vertical of the camera that captured everybody in "duet-motion" JSON documents,
// like `duet inspect` of files with these contents.
//
// Errors: those of `duet inspect`.
absl::StatusOr<motion::VerticalEstimate> EstimateVertical(
    const std::vector<std::string>& documents);

// The message of an error, with the name of the argument that would help, if any.
std::string DescribeError(const absl::Status& error);

}  // namespace duet::client::python::extension

#endif  // DUET_CLIENT_PYTHON_EXTENSION_MOTION_FILES_H_
