#ifndef DUET_CLIENT_CLI_SERVER_OPTIONS_H_
#define DUET_CLIENT_CLI_SERVER_OPTIONS_H_

#include <ostream>

#include "absl/status/statusor.h"
#include "client/cli/server_arguments.h"
#include "client/options.h"

namespace duet::client::cli {

// The client options for these flags. Reads the files of certificates and the token.
absl::StatusOr<ClientOptions> ToClientOptions(const ServerArguments& arguments);

// Makes the client report on `err`, once, that it retries a server that does not answer: after two
// attempts, because most outages are shorter. `err` outlives the client.
void ReportWaiting(const ServerArguments& arguments, std::ostream& err, ClientOptions* options);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SERVER_OPTIONS_H_
