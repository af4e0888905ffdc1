#ifndef DUET_CLIENT_CLI_RIG_FLAGS_H_
#define DUET_CLIENT_CLI_RIG_FLAGS_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/flag_set.h"
#include "client/cli/motion_arguments.h"
#include "model/formats/follower_rig.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {

// --rig of `duet convert` and the flags that describe its file.
void AddRigFlags(FlagSet* app, RigArguments* rig);

// The flags that specify how the file of a rig is read: `prefix` with -up-axis, -metres-per-unit,
// -joint-map and -joint-map-file. `what` is the file in help. Returns the flags.
std::vector<Flag*> AddRigReadingFlags(FlagSet* app, const std::string& prefix,
                                      const std::string& what, RigArguments* rig);

// Checks that the rig can be written in the format of every output. Calls RejectFlag if it cannot,
// for use during parsing.
void CheckRigFlags(const RigArguments& rig, const std::vector<std::filesystem::path>& outputs);

// The rig that `arguments` names. Errors: those of reading the table of joints.
absl::StatusOr<formats::FollowerRig> ReadRigArguments(const RigArguments& arguments,
                                                      const motion::Skeleton& skeleton);

// The error of reading a rig's file: the joint map that would fix it is the rig's.
absl::Status OfRig(const absl::Status& status);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_RIG_FLAGS_H_
