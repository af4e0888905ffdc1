#ifndef DUET_CLIENT_CLI_MOTION_INPUT_H_
#define DUET_CLIENT_CLI_MOTION_INPUT_H_

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/motion_file.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

// Motion files as a command reads them: the flags that override what a file states, and the
// reading.

namespace duet::client::cli {

// The person who is read by default from a file with two people.
inline constexpr formats::Side kDefaultSide = formats::Side::kLeft;

inline constexpr char kInputGroup[] = "Input";
inline constexpr char kOutputGroup[] = "Output";

// How to read a motion file. Overrides what the file states.
struct InputArguments {
  std::optional<formats::Format> format;
  std::optional<double> frame_rate_hz;
  std::optional<double> metres_per_unit;
  std::vector<std::string> joint_map;  // "left_hand=LeftWrist", or files with such lines
  std::optional<motion::LengthUnit> unit;
  std::optional<motion::UpAxis> up_axis;
  std::optional<std::string> animation;
};

// --input-format, --frame-rate, --metres-per-unit and --joint-map.
void AddReadingFlags(CLI::App* app, InputArguments* input);
// The same with --unit, --up-axis and --animation, for commands that only read and write files.
void AddInputFlags(CLI::App* app, InputArguments* input);

// The syntax of axes. Errors: INVALID_ARGUMENT "expected ..., got ...".
absl::StatusOr<motion::UpAxis> ParseAxis(absl::string_view text);

// Like formats::ReadLeader. Warns in the report of a person of no likely size.
absl::StatusOr<motion::Clip> ReadMotion(const std::filesystem::path& file,
                                        const formats::ReadOptions& options);

// All people of a file, at most two.
struct ReadPeople {
  std::vector<motion::Clip> people;
  std::vector<std::string> notes;  // on how the first was read
};
// Like ReadMotion, for a file that exists and has a known format.
absl::StatusOr<ReadPeople> ReadAllPeople(const std::filesystem::path& file,
                                         const formats::ReadOptions& options);

// The values of --joint-map. A pair overrides a line of a file.
absl::StatusOr<retargeting::JointOverrides> ReadJoints(const std::vector<std::string>& joint_map);

// Reads the tables of joints that the flags name, if any.
absl::StatusOr<formats::ReadOptions> ToReadOptions(const InputArguments& input,
                                                   const motion::Skeleton& skeleton);

// The skeleton of `file`, or the 15 joints of sbu if it is empty. The file has a JSON object with
// the fields `joint_names` and `bones` (pairs of indices, parent and child): one of the models that
// `duet models --json` prints, or a motion in duet-motion JSON. The root is the joint that is no
// bone's child. Other fields are ignored. Errors: INVALID_ARGUMENT naming the file and the field;
// those of reading a file.
absl::StatusOr<motion::Skeleton> SkeletonOf(const std::filesystem::path& file);
// --skeleton, for commands that read motions without a server.
void AddSkeletonFlag(CLI::App* app, std::filesystem::path* file);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_MOTION_INPUT_H_
