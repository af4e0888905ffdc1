#ifndef DUET_CLIENT_CLI_TAKE_H_
#define DUET_CLIENT_CLI_TAKE_H_

#include <filesystem>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/motion_arguments.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {

// The motions that duet view and duet compare show: "[NAME=]FILE" or "[NAME=]LEADER,FOLLOWER".
struct TakeArguments {
  std::vector<std::string> takes;
  // Who leads in a file with two people: one value for all files, or one for each file.
  std::vector<formats::Side> leader_sides = {kDefaultSide};
  InputArguments input;
};

// One motion that is shown or compared: a leader and a follower, or one person.
struct Take {
  std::string name;
  std::vector<std::filesystem::path> files;  // one, or the leader's and the follower's
  motion::Clip leader;
  std::optional<motion::Clip> follower;  // the leader's frames and rate
  std::vector<std::string> notes;        // on how it was read
};

// The files of a take as "[NAME=]FILE" or "[NAME=]LEADER,FOLLOWER" says; what is the name of a file
// as it stands is that file. pair.leader.bvh has pair.follower.bvh for its follower, where that
// lies beside it. Without a name the file's.
struct TakeFiles {
  std::string name;
  std::vector<std::filesystem::path> files;
};
TakeFiles ParseTake(const std::string& text);

// Reads them all; a file that already is another take's follower is passed over. Two files of
// differing rates are brought to the leader's, and both end with the shorter one.
// Errors: those of reading, naming the file.
absl::StatusOr<std::vector<Take>> ReadTakes(const TakeArguments& arguments,
                                            const motion::Skeleton& skeleton, std::istream* in);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_TAKE_H_
