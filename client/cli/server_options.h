#ifndef DUET_CLIENT_CLI_SERVER_OPTIONS_H_
#define DUET_CLIENT_CLI_SERVER_OPTIONS_H_

#include <ostream>

#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/options.h"

namespace duet::client::cli {

// The flags as a client's options; reads the certificates that they name.
absl::StatusOr<ClientOptions> ToClientOptions(const ServerArguments& arguments);

// Has a client report on `err`, once, that a server does not answer and that it is retried: after
// two attempts, since most outages are shorter. `err` outlives the client.
void SayWhenWaiting(const ServerArguments& arguments, std::ostream& err, ClientOptions* options);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SERVER_OPTIONS_H_
