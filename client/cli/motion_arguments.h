#ifndef DUET_CLIENT_CLI_MOTION_ARGUMENTS_H_
#define DUET_CLIENT_CLI_MOTION_ARGUMENTS_H_

#include <filesystem>
#include <optional>
#include <string>

#include "model/formats/motion_file.h"

namespace duet::client::cli {

// The person who is read by default from a file with two people.
inline constexpr formats::Side kDefaultSide = formats::Side::kLeft;

// Standard input or output in place of a file.
inline constexpr char kStandardStream[] = "-";

// How to read a motion file. Overrides what the file states.
struct InputArguments {
  std::optional<formats::Format> format;
  std::optional<double> frame_rate_hz;
  std::optional<motion::LengthUnit> unit;
  std::optional<motion::UpAxis> up_axis;
  std::optional<double> metres_per_unit;
  std::optional<std::string> animation;
  retargeting::JointOverrides joints;
  std::filesystem::path joint_table;  // a file of joints, which `joints` override
};

// The rig that a person is written onto, and how to read its file.
struct RigArguments {
  std::filesystem::path file;  // empty: Duet's own rig
  std::optional<formats::Side> side;
  std::optional<motion::UpAxis> up_axis;
  std::optional<double> metres_per_unit;
  retargeting::JointOverrides joints;
  std::filesystem::path joint_table;  // a file of joints, which `joints` override
};

// The kind of output: a motion, or an HTML page.
struct OutputFormat {
  std::optional<formats::Format> motion;  // absent: a page
};

// How to write .bvh.
struct BvhArguments {
  double metres_per_unit = formats::kCentimetre;
  int keys_per_frame = 1;
};

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_MOTION_ARGUMENTS_H_
