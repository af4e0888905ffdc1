#ifndef DUET_CLIENT_CLI_RIG_FLAGS_H_
#define DUET_CLIENT_CLI_RIG_FLAGS_H_

#include <filesystem>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/flag_set.h"
#include "model/formats/follower_rig.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {

// The rig that `duet convert` writes a person onto, and how to read its file.
struct RigArguments {
  std::filesystem::path file;  // empty: Duet's own rig
  std::optional<formats::Side> side;
  std::optional<motion::UpAxis> up_axis;
  std::optional<double> metres_per_unit;
  retargeting::JointOverrides joints;
  std::filesystem::path joint_table;  // a file of joints, which `joints` override
};

// --rig and the flags that describe its file.
void AddRigFlags(FlagSet* app, RigArguments* rig);

// Checks that the rig can be written in the format of every output. Calls RejectFlag if it cannot,
// for use during parsing.
void CheckRigFlags(const RigArguments& rig, const std::vector<std::filesystem::path>& outputs);

// The rig, or nullopt without --rig. Errors: those of reading the table of joints.
absl::StatusOr<std::optional<formats::FollowerRig>> ReadRigArguments(
    const RigArguments& arguments, const motion::Skeleton& skeleton);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_RIG_FLAGS_H_
