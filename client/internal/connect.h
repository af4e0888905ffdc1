#ifndef DUET_CLIENT_INTERNAL_CONNECT_H_
#define DUET_CLIENT_INTERNAL_CONNECT_H_

#include <memory>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/connection.h"
#include "client/options.h"
#include "grpcpp/channel.h"

namespace duet::client::internal {

// Creates a connection over gRPC, which connects with its first call. Returns INVALID_ARGUMENT if
// an option is invalid.
absl::StatusOr<std::shared_ptr<Connection>> Connect(const ClientOptions& options);

// Creates the channel that the options describe, which connects with its first call. Returns
// INVALID_ARGUMENT if an option is invalid.
absl::StatusOr<std::shared_ptr<grpc::Channel>> OpenChannel(const ClientOptions& options);

// Returns the gRPC target of an address. "host:port" becomes a target that resolves to every server
// behind the name. An address that is already a target is returned unchanged.
std::string GrpcTarget(std::string_view server_address);

// What errors call the fields of TlsOptions.
struct TlsNames {
  std::string root_certificates = "tls.root_certificates";
  std::string certificate_chain = "tls.certificate_chain";
  std::string private_key = "tls.private_key";
};

// Checks what gRPC does not: with text that is no PEM, it makes a channel that has no address to
// call, as if there were no server. INVALID_ARGUMENT, never with any part of the key.
absl::Status CheckTls(const TlsOptions& tls, const TlsNames& names = {});

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_CONNECT_H_
