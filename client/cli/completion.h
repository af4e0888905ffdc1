#ifndef DUET_CLIENT_CLI_COMPLETION_H_
#define DUET_CLIENT_CLI_COMPLETION_H_

#include <string>

#include "client/cli/flag_set.h"

namespace duet::client::cli {

// A script that makes a shell ("bash", "zsh" or "fish") complete commands, flags, their choices and
// files. It holds all it needs: completing does not run the program.
std::string CompletionScript(const FlagSet& app, const std::string& shell);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_COMPLETION_H_
