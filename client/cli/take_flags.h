#ifndef DUET_CLIENT_CLI_TAKE_FLAGS_H_
#define DUET_CLIENT_CLI_TAKE_FLAGS_H_

#include <filesystem>

#include "client/cli/flag_set.h"
#include "client/cli/take.h"

// The flags that duet view and duet compare share.

namespace duet::client::cli {

// The end of their --help.
inline constexpr char kTakesFooter[] = R"(
Each FILE is a motion of one or two people: FILE, NAME=FILE, or LEADER.bvh,FOLLOWER.bvh
(walk.leader.bvh includes walk.follower.bvh if that exists).
)";

// How to read the takes: --leader-side and the input flags.
void AddTakeFlags(FlagSet* app, TakeArguments* takes);

// Call RejectFlag if the flags contradict each other, or if the page cannot be written.
void CheckTakes(const TakeArguments& takes);
void CheckPage(const char* flag, const std::filesystem::path& page);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_TAKE_FLAGS_H_
