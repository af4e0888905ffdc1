#ifndef DUET_CLIENT_CLI_SERVER_ARGUMENTS_H_
#define DUET_CLIENT_CLI_SERVER_ARGUMENTS_H_

#include <string>

#include "absl/time/time.h"
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

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SERVER_ARGUMENTS_H_
