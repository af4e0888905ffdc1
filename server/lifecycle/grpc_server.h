#ifndef DUET_SERVER_LIFECYCLE_GRPC_SERVER_H_
#define DUET_SERVER_LIFECYCLE_GRPC_SERVER_H_

#include <grpcpp/resource_quota.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server.h>

#include <cstddef>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "duet/v1/server_config.pb.h"
#include "server/common/listen_address.h"

namespace duet::server::lifecycle {

// The part of the settings that gRPC itself enforces.
struct GrpcServerOptions {
  common::ListenAddress listen;
  bool reflection = false;
  std::size_t max_request_bytes = 0;
  std::size_t max_transport_bytes = 0;
  int max_calls = 0;
  // After this time a connection takes no new calls, and ends with its last call.
  double connection_age_seconds = 1800;
  std::shared_ptr<grpc::ServerCredentials> credentials = nullptr;  // null: plain text
  // Outlives the server. Null: a quota of max_transport_bytes for this server only.
  const grpc::ResourceQuota* quota = nullptr;
};

struct GrpcServer {
  std::shared_ptr<grpc::ServerCredentials> credentials;  // used while the server listens
  std::unique_ptr<grpc::Server> server;
  int port = 0;
};

// Starts gRPC with the service, the standard health service (everything SERVING at first) and, if
// requested, reflection. `service` outlives the server.
// Fails with UNAVAILABLE and the reason if it cannot listen on the address.
absl::StatusOr<GrpcServer> StartGrpcServer(const GrpcServerOptions& options,
                                           grpc::Service& service);

// Checks whether the server still answers calls: calls its health service in process, so that
// neither certificates nor tokens matter. gRPC's callback threads answer it like every call. If all
// of them hang, the kernel and gRPC still accept connections, but no call is answered. Fails with
// UNAVAILABLE.
absl::Status CheckAnswers(grpc::Server& server, double timeout_seconds);

// Checks whether a server still accepts connections: connects, closes its side at once, and waits
// for data or for the end of the connection.
//
// A listening socket is not enough. gRPC 1.51 stops accepting permanently after it has run out of
// descriptors (CVE-2023-4785), while the kernel continues to complete connections.
//
// `host` is an address that the server listens on; if it means every interface, this machine's
// loopback address is used. Fails with UNAVAILABLE and the step that failed.
absl::Status CheckListener(const std::string& host, int port, double timeout_seconds);

// Asks the server that runs on this machine with these settings for /healthz, which needs neither
// certificates nor tokens. Without a metrics port, checks whether its gRPC port accepts
// connections. Fails with UNAVAILABLE and the reason if the server is not healthy.
absl::Status CheckHealth(const v1::ServerConfig& settings, double timeout_seconds);

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_GRPC_SERVER_H_
