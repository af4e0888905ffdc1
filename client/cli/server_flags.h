#ifndef DUET_CLIENT_CLI_SERVER_FLAGS_H_
#define DUET_CLIENT_CLI_SERVER_FLAGS_H_

#include "CLI/CLI.hpp"
#include "client/cli/arguments.h"

namespace duet::client::cli {

// --server and how to speak to it.
void AddServerFlags(CLI::App* app, ServerArguments* server);
// All but --server itself and --wait.
void AddConnectionFlags(CLI::App* app, ServerArguments* server);
// The same without --timeout.
void AddCredentialFlags(CLI::App* app, ServerArguments* server);

inline constexpr char kServerGroup[] = "Server";

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SERVER_FLAGS_H_
