#ifndef DUET_CLIENT_CLI_SERVER_H_
#define DUET_CLIENT_CLI_SERVER_H_

#include <CLI/CLI.hpp>
#include <string>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/cli/command.h"
#include "client/options.h"

namespace duet::client::cli {

// The server, and how to connect to it.
struct ServerArguments {
  std::string address = ClientOptions().server_address;
  double timeout_seconds = absl::ToDoubleSeconds(ClientOptions().deadline);
  double wait_seconds = absl::ToDoubleSeconds(ClientOptions().wait);
  bool tls = false;  // implied by each of the tls_ fields
  std::string tls_ca_file;
  std::string tls_certificate_file;
  std::string tls_key_file;
  std::string tls_server_name;
  std::string token_file;
  std::string authority;
};

// --server, --wait, and the connection flags.
void AddServerFlags(CLI::App* app, ServerArguments* server);
// --timeout and the credential flags.
void AddConnectionFlags(CLI::App* app, ServerArguments* server);

inline constexpr char kServerGroup[] = "Server";

// The client options for these flags. Reads the files of certificates and the token.
absl::StatusOr<ClientOptions> ToClientOptions(const ServerArguments& arguments);

// A client of the server, as `environment` connects. It reports on `environment.err`, once, that it
// retries a server that does not answer: after two attempts, because most outages are shorter. The
// stream outlives the client. Errors: those of ToClientOptions and of connecting.
absl::StatusOr<Client> Connect(const ServerArguments& arguments,
                               const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SERVER_H_
