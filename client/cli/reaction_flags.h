#ifndef DUET_CLIENT_CLI_REACTION_FLAGS_H_
#define DUET_CLIENT_CLI_REACTION_FLAGS_H_

#include "client/cli/flag_set.h"
#include "client/cli/synthesize_arguments.h"

// The flags that duet synthesize and duet live share.

namespace duet::client::cli {

// How the leader's file is read: --leader-side, the input flags, --level.
void AddReadingFlags(FlagSet* app, SynthesizeArguments* arguments);

Flag* AddLabelFlag(FlagSet* app, SynthesizeArguments* arguments);
void AddModelFlag(FlagSet* app, SynthesizeArguments* arguments);
// --follower-start, --follower-start-side, --partner-direction
void AddStartFlags(FlagSet* app, SynthesizeArguments* arguments);
// --seed, --variety, --candidates
void AddSamplingFlags(FlagSet* app, SynthesizeArguments* arguments);
void AddCleanUpFlag(FlagSet* app, SynthesizeArguments* arguments);
void AddRequestIdFlag(FlagSet* app, SynthesizeArguments* arguments);

inline constexpr char kReactionGroup[] = "Reaction";

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_REACTION_FLAGS_H_
