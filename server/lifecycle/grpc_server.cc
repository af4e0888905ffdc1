#include "server/lifecycle/grpc_server.h"

#include <grpc/impl/codegen/compression_types.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/impl/server_builder_option.h>
#include <grpcpp/server_builder.h>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "absl/cleanup/cleanup.h"
#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
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

namespace {

constexpr absl::string_view kRequest =
    "GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";

absl::Status Failure(absl::string_view step, absl::string_view error) {
  return absl::UnavailableError(
      absl::StrCat("the server does not answer on its own port: ", step, ": ", error));
}

std::string Reachable(const std::string& host) {
  if (host.empty() || host == "0.0.0.0") return "127.0.0.1";
  return host == "::" ? "::1" : host;
}

// Sends `text` to a server on this machine, or ends the output if it is empty, and returns the
// first line that the server sends: empty if it only ends the connection. If `address` means every
// interface, this machine's loopback address is used. Blocks, each step for at most
// `timeout_seconds`. Fails with UNAVAILABLE and the step.
absl::StatusOr<std::string> Ask(const common::ListenAddress& address, absl::string_view text,
                                double timeout_seconds) {
  addrinfo hints = {};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int unresolved = getaddrinfo(Reachable(address.host).c_str(),
                                     std::to_string(address.port).c_str(), &hints, &found);
  if (unresolved != 0) {
    return Failure(absl::StrCat("cannot resolve ", address.host), gai_strerror(unresolved));
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
  const int descriptor = socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return Failure("cannot open a socket", std::strerror(errno));
  const auto closing = absl::MakeCleanup([descriptor] { close(descriptor); });
  timeval timeout = {};
  timeout.tv_sec = static_cast<time_t>(timeout_seconds);
  timeout.tv_usec =
      static_cast<suseconds_t>((timeout_seconds - static_cast<double>(timeout.tv_sec)) * 1e6);
  setsockopt(descriptor, SOL_SOCKET, SO_SNDTIMEO, &timeout, sizeof(timeout));  // also of connect
  setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof(timeout));
  if (connect(descriptor, found->ai_addr, found->ai_addrlen) != 0) {
    return Failure("cannot connect", std::strerror(errno));
  }
  if (send(descriptor, text.data(), text.size(), MSG_NOSIGNAL) < 0 ||
      (text.empty() && shutdown(descriptor, SHUT_WR) != 0)) {
    return Failure("cannot send", std::strerror(errno));
  }
  char answer[256];
  const ssize_t size = recv(descriptor, answer, sizeof(answer), 0);
  if (size < 0) return Failure("connected, but got no answer", std::strerror(errno));
  const absl::string_view received(answer, static_cast<std::size_t>(size));
  return std::string(received.substr(0, received.find("\r\n")));
}

}  // namespace

absl::Status CheckListener(const std::string& host, int port, double timeout_seconds) {
  // Sends nothing: plain text would be an error in the log of a server with TLS, and a TLS
  // handshake needs certificates. Data, or the end of the connection, shows that the server
  // accepted it.
  return Ask({host, port}, "", timeout_seconds).status();
}

absl::Status CheckHealth(const v1::ServerConfig& settings, double timeout_seconds) {
  const std::optional<common::ListenAddress> metrics = common::AddressOf(settings.metrics_listen());
  if (!metrics.has_value()) {
    const std::optional<common::ListenAddress> grpc = common::AddressOf(settings.listen());
    if (!grpc.has_value()) return absl::UnavailableError("listen: expected host:port, got none");
    return CheckListener(grpc->host, grpc->port, timeout_seconds);
  }
  const absl::StatusOr<std::string> answer = Ask(*metrics, kRequest, timeout_seconds);
  if (!answer.ok()) return answer.status();
  if (absl::StartsWith(*answer, "HTTP/1.1 200 ")) return absl::OkStatus();
  return absl::UnavailableError(
      absl::StrCat("/healthz: expected the status 200, got \"", *answer, "\""));
}

}  // namespace duet::server::lifecycle
