#ifndef DUET_CLIENT_CLI_SERVER_OPTIONS_H_
#define DUET_CLIENT_CLI_SERVER_OPTIONS_H_

#include "absl/status/statusor.h"
#include "client/cli/program_environment.h"
#include "client/cli/server_arguments.h"
#include "client/options.h"

namespace duet::client::cli {

// The client options for these flags. Reads the files of certificates and the token.
absl::StatusOr<ClientOptions> ToClientOptions(const ServerArguments& arguments);

// A client of the server, as `environment` connects. It reports on `environment.err`, once, that it
// retries a server that does not answer: after two attempts, because most outages are shorter. The
// stream outlives the client. Errors: those of ToClientOptions and of connecting.
absl::StatusOr<Client> Connect(const ServerArguments& arguments,
                               const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SERVER_OPTIONS_H_
