#ifndef DUET_CLIENT_CLI_SYNTHESIZE_FLAGS_H_
#define DUET_CLIENT_CLI_SYNTHESIZE_FLAGS_H_

#include "CLI/CLI.hpp"
#include "client/cli/arguments.h"

namespace duet::client::cli {

// duet synthesize.
CLI::App* AddSynthesizeCommand(CLI::App* app, SynthesizeArguments* arguments);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SYNTHESIZE_FLAGS_H_
