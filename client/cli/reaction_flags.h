#ifndef DUET_CLIENT_CLI_REACTION_FLAGS_H_
#define DUET_CLIENT_CLI_REACTION_FLAGS_H_

#include "CLI/CLI.hpp"
#include "client/cli/synthesize_arguments.h"

// The flags that duet synthesize and duet live share.

namespace duet::client::cli {

// How the leader's file is read: --leader-side, the input flags, --level.
void AddReadingFlags(CLI::App* app, SynthesizeArguments* arguments);

CLI::Option* AddLabelFlag(CLI::App* app, SynthesizeArguments* arguments);
void AddModelFlag(CLI::App* app, SynthesizeArguments* arguments);
// --follower-start, --follower-start-side, --partner-direction
void AddStartFlags(CLI::App* app, SynthesizeArguments* arguments);
// --seed, --variety, --candidates
void AddSamplingFlags(CLI::App* app, SynthesizeArguments* arguments);
void AddCleanUpFlag(CLI::App* app, SynthesizeArguments* arguments);
void AddRequestIdFlag(CLI::App* app, SynthesizeArguments* arguments);

inline constexpr char kReactionGroup[] = "Reaction";

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_REACTION_FLAGS_H_
