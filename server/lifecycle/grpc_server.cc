#include "server/lifecycle/grpc_server.h"

#include <grpc/impl/codegen/compression_types.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/impl/server_builder_option.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/common/listen_address.h"

namespace duet::server::lifecycle {
namespace {

constexpr int kSecond = 1000;  // in channel arguments
constexpr int kMinute = 60 * kSecond;

// Removes reflection from one server. The library adds it to every server of a process that links
// it, and has no other switch.
class WithoutReflection final : public grpc::ServerBuilderOption {
 public:
  void UpdateArguments(grpc::ChannelArguments*) override {}
  void UpdatePlugins(std::vector<std::unique_ptr<grpc::ServerBuilderPlugin>>* plugins) override {
    plugins->erase(std::remove_if(plugins->begin(), plugins->end(),
                                  [](const auto& plugin) {
                                    return plugin->name() == "proto_server_reflection";
                                  }),
                   plugins->end());
  }
};

void SetConnectionLimits(grpc::ServerBuilder& builder, const GrpcServerOptions& options) {
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, kMinute);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 20 * kSecond);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  // Callers may send pings every ten seconds, also on a stream without messages. The limit is
  // lower, because pings do not arrive at regular intervals.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 5 * kSecond);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, 5 * kMinute);
  // Old connections take no new calls, so that clients discover new replicas. Running calls end by
  // themselves at max_call_seconds, but live sessions may last: the connection has no grace period,
  // at whose end gRPC would end them.
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_MS,
                             static_cast<int>(options.connection_age_seconds * kSecond));
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, 10 * kSecond);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, 2 * options.max_calls);
  // A second server on the same port fails to start instead of taking half of the connections.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
}

void SetMessageLimits(grpc::ServerBuilder& builder, const GrpcServerOptions& options) {
  // Twice the limit, so that most requests that are too large get our own error with details.
  builder.SetMaxReceiveMessageSize(static_cast<int>(2 * options.max_request_bytes));
  // A small compressed message may decompress to any size before the size is checked, and positions
  // hardly compress.
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_DEFLATE, false);
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_GZIP, false);
  // gRPC receives a whole message before it checks its size.
  builder.SetResourceQuota(options.quota != nullptr
                               ? *options.quota
                               : grpc::ResourceQuota("duet").Resize(options.max_transport_bytes));
}

}  // namespace

absl::StatusOr<GrpcServer> StartGrpcServer(const GrpcServerOptions& options,
                                           grpc::Service& service) {
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  GrpcServer started;
  started.credentials =
      options.credentials == nullptr ? grpc::InsecureServerCredentials() : options.credentials;
  builder.AddListeningPort(ToString(options.listen), started.credentials, &started.port);
  builder.RegisterService(&service);
  if (!options.reflection) builder.SetOption(std::make_unique<WithoutReflection>());
  SetConnectionLimits(builder, options);
  SetMessageLimits(builder, options);
  started.server = builder.BuildAndStart();
  if (started.server == nullptr) {
    return common::ListenFailure(options.listen.host, options.listen.port);
  }
  return started;
}

absl::Status CheckAnswers(grpc::Server& server, double timeout_seconds) {
  grpc::GenericStub stub(server.InProcessChannel(grpc::ChannelArguments()));
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() +
                       std::chrono::duration_cast<std::chrono::system_clock::duration>(
                           std::chrono::duration<double>(timeout_seconds)));
  grpc::CompletionQueue queue;
  const grpc::Slice no_fields;
  const auto call = stub.PrepareUnaryCall(&context, "/grpc.health.v1.Health/Check",
                                          grpc::ByteBuffer(&no_fields, 1), &queue);
  call->StartCall();
  grpc::ByteBuffer response;
  grpc::Status status;
  call->Finish(&response, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);  // returns at the deadline at the latest
  if (status.ok()) return absl::OkStatus();
  return absl::UnavailableError(
      absl::StrCat("the server does not answer its own call: ", status.error_message()));
}

}  // namespace duet::server::lifecycle
