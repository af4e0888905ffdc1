#ifndef DUET_CLIENT_CLI_SERVER_FLAGS_H_
#define DUET_CLIENT_CLI_SERVER_FLAGS_H_

#include "client/cli/flag_set.h"
#include "client/cli/server_arguments.h"

namespace duet::client::cli {

// --server, --wait, and the connection flags.
void AddServerFlags(FlagSet* app, ServerArguments* server);
// --timeout and the credential flags.
void AddConnectionFlags(FlagSet* app, ServerArguments* server);
// TLS, the token, and the name for a proxy.
void AddCredentialFlags(FlagSet* app, ServerArguments* server);

inline constexpr char kServerGroup[] = "Server";

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SERVER_FLAGS_H_
