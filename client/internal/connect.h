#ifndef DUET_CLIENT_INTERNAL_CONNECT_H_
#define DUET_CLIENT_INTERNAL_CONNECT_H_

#include <memory>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "client/connection.h"
#include "client/options.h"
#include "grpcpp/channel.h"

namespace duet::client::internal {

// A connection over gRPC. INVALID_ARGUMENT when an option makes no sense. Connects lazily.
absl::StatusOr<std::shared_ptr<Connection>> Connect(const ClientOptions& options);

// A channel to where the options say. INVALID_ARGUMENT when one makes no sense. Connects lazily.
absl::StatusOr<std::shared_ptr<grpc::Channel>> OpenChannel(const ClientOptions& options);

// The gRPC target of an address: "host:port" becomes one that resolves to every server behind the
// name; an address that is a target already stays as it is.
std::string GrpcTarget(std::string_view server_address);

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_CONNECT_H_
