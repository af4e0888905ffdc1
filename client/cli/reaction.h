#ifndef DUET_CLIENT_CLI_REACTION_H_
#define DUET_CLIENT_CLI_REACTION_H_

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/batch/text_values.h"
#include "client/cli/motion_input.h"
#include "client/cli/server.h"
#include "client/request.h"
#include "client/result.h"
#include "model/motion/skeleton.h"

// The request that duet synthesize and duet live send: a file, and flags that override it.

namespace duet::client::cli {

struct ReactionArguments {
  std::filesystem::path request;  // empty: no file
  std::filesystem::path leader;   // empty: one that is no file
  formats::Side leader_side = kDefaultSide;
  InputArguments input;
  // The fields that flags set in the request.
  std::optional<ModelChoice> model;
  std::vector<ClassWeight> weights;
  std::vector<WeightKeyframe> keyframes;
  std::string follower_start;  // "X,Y,Z" or a motion file
  std::optional<uint64_t> seed;
  std::optional<float> variety;
  std::optional<int> candidates;
};

// --request, --label, --keyframe, --model, --follower-start, --seed, --variety and --candidates.
void AddReactionFlags(CLI::App* app, ReactionArguments* arguments);
inline constexpr char kReactionGroup[] = "Reaction";

// --leader-side and the flags of reading the leader's file.
void AddLeaderFlags(CLI::App* app, ReactionArguments* arguments);

// The syntax of values, as in recipes. Errors: INVALID_ARGUMENT "expected ..., got ...".
using batch::ParseModelChoice;
using batch::ParseSeed;
// "kick=0.5", or "kick" for a weight of 1. The server checks the class and the range.
absl::StatusOr<ClassWeight> ParseClassWeight(absl::string_view text);
// "30:kick=1,hug=0": weights at a frame.
absl::StatusOr<WeightKeyframe> ParseKeyframe(absl::string_view text);

// Reads a duet.v1.SynthesizeRequest in protobuf's text format, without a leader, whose file a flag
// names, and without reply_joint_names.
//
// Errors: INVALID_ARGUMENT "FILE: line 3:5: ..." for text that is no such message, and "FILE:
// field: expected ..., got ..."; those of reading a file. The server checks what depends on the
// model.
absl::StatusOr<SynthesisRequest> ReadRequestFile(const std::filesystem::path& file);

// What a command has before it reads motions.
struct PreparedCall {
  // That of the file with the fields of the flags, except those that are read in a model's joints:
  // the leader and the follower's start.
  SynthesisRequest request;
  Client client;
  bool samples = false;  // the model samples
  motion::Skeleton skeleton;
};

// Checks the files of the flags and the request, with `check`, and connects. Errors: the first of
// these, and those of the server.
absl::StatusOr<PreparedCall> PrepareCall(
    const ReactionArguments& arguments, const ServerArguments& server,
    const std::function<absl::Status(const SynthesisRequest&)>& check,
    const ProgramEnvironment& environment);

// Reads the follower's start and, if the flags name one, the leader, in the skeleton's joints.
// `notes`, which may be null, receives the choices that were made.
absl::Status ReadMotions(const ReactionArguments& arguments, const motion::Skeleton& skeleton,
                         SynthesisRequest* request, std::vector<std::string>* notes);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_REACTION_H_
