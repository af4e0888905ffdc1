#ifndef DUET_CLIENT_CLI_SERVER_OPTIONS_H_
#define DUET_CLIENT_CLI_SERVER_OPTIONS_H_

#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/options.h"

namespace duet::client::cli {

// The flags as a client's options; reads the certificates that they name.
absl::StatusOr<ClientOptions> ToClientOptions(const ServerArguments& arguments);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SERVER_OPTIONS_H_
