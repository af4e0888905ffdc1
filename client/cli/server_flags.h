#ifndef DUET_CLIENT_CLI_SERVER_FLAGS_H_
#define DUET_CLIENT_CLI_SERVER_FLAGS_H_

#include "CLI/CLI.hpp"
#include "client/cli/server_arguments.h"

namespace duet::client::cli {

// --server, --wait, and the connection flags.
void AddServerFlags(CLI::App* app, ServerArguments* server);
// --timeout and the credential flags.
void AddConnectionFlags(CLI::App* app, ServerArguments* server);
// TLS, the token, and the name for a proxy.
void AddCredentialFlags(CLI::App* app, ServerArguments* server);

inline constexpr char kServerGroup[] = "Server";

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SERVER_FLAGS_H_
