#ifndef DUET_CLIENT_CLI_SKELETON_FILE_H_
#define DUET_CLIENT_CLI_SKELETON_FILE_H_

#include <CLI/CLI.hpp>
#include <filesystem>

#include "absl/status/statusor.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {

// Reads the joints of a skeleton from a JSON object with the fields `joint_names`, `bones` (pairs
// of indices, parent and child) and `root_joint`: one of the models that `duet models --json`
// prints, or a motion in duet-motion JSON. Without `root_joint`, the root is the joint that is no
// bone's child. Other fields are ignored. Errors: INVALID_ARGUMENT naming the file and the field;
// those of reading a file.
absl::StatusOr<motion::Skeleton> ReadSkeletonFile(const std::filesystem::path& file);

// The skeleton of `file`, or the 15 joints of sbu if it is empty.
absl::StatusOr<motion::Skeleton> SkeletonOf(const std::filesystem::path& file);

// --skeleton, for commands that read motions without a server.
void AddSkeletonFlag(CLI::App* app, std::filesystem::path* file);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SKELETON_FILE_H_
