#include "client/internal/connect.h"

#include <algorithm>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "client/internal/connection_impl.h"
#include "client/internal/grpc_stub.h"
#include "grpcpp/create_channel.h"
#include "grpcpp/security/credentials.h"
#include "grpcpp/support/channel_arguments.h"

namespace duet::client::internal {
namespace {

// Calls take turns over all servers behind the name whose health service says that they serve, so
// that a draining server gets no new work. The empty service name asks for the server as a whole.
constexpr char kServiceConfig[] = R"({
  "loadBalancingConfig": [{"round_robin": {}}],
  "healthCheckConfig": {"serviceName": ""}
})";

constexpr absl::Duration kLongestReconnectWait = absl::Seconds(1);
// The longest that one attempt to connect may take, handshake included: gRPC's own 20 s are long
// where a firewall drops packets.
constexpr absl::Duration kConnectTimeout = absl::Seconds(5);

bool IsToken(absl::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return absl::ascii_isgraph(c); });
}

// Whether what is sent to an address leaves this machine by no network. A host name other than
// localhost may be anybody's.
bool IsThisMachine(absl::string_view address) {
  if (absl::StartsWith(address, "unix:") || absl::StartsWith(address, "unix-abstract:")) {
    return true;
  }
  for (const char* scheme : {"dns:///", "dns:", "ipv4:", "ipv6:"}) {
    if (absl::ConsumePrefix(&address, scheme)) break;
  }
  // Several addresses behind one target would each have to be looked at.
  if (absl::StrContains(address, ',')) return false;
  if (address == "[::1]" || absl::StartsWith(address, "[::1]:")) return true;
  const absl::string_view host = address.substr(0, address.find(':'));
  if (host == "localhost") return true;
  // 127.0.0.0/8 as four numbers: "127.example.com" is a name.
  return absl::StartsWith(host, "127.") &&
         std::all_of(host.begin(), host.end(),
                     [](unsigned char c) { return absl::ascii_isdigit(c) || c == '.'; });
}

absl::Status Check(const ClientOptions& options) {
  if (options.server_address.empty()) {
    return absl::InvalidArgumentError("server_address: empty, wanted host:port");
  }
  if (options.deadline <= absl::ZeroDuration()) {
    return absl::InvalidArgumentError(
        absl::StrCat("deadline: ", absl::FormatDuration(options.deadline), ", wanted more than 0"));
  }
  if (options.wait < absl::ZeroDuration()) {
    return absl::InvalidArgumentError(
        absl::StrCat("wait: expected 0 or more, got ", absl::FormatDuration(options.wait)));
  }
  const RetryOptions& retry = options.retry;
  if (retry.max_attempts < 1) {
    return absl::InvalidArgumentError(
        absl::StrCat("retry.max_attempts: ", retry.max_attempts, ", wanted 1 or more"));
  }
  if (retry.initial_backoff <= absl::ZeroDuration() || retry.max_backoff < retry.initial_backoff) {
    return absl::InvalidArgumentError(absl::StrCat(
        "retry: initial_backoff ", absl::FormatDuration(retry.initial_backoff), ", max_backoff ",
        absl::FormatDuration(retry.max_backoff), ", wanted 0 < initial <= max"));
  }
  if (!IsToken(options.token)) {
    // Not repeated: messages go to logs.
    return absl::InvalidArgumentError(
        "token: has a blank or a character that is not printable ASCII, wanted none");
  }
  if (!options.token.empty() && !options.tls.has_value() &&
      !IsThisMachine(options.server_address)) {
    return absl::InvalidArgumentError(absl::StrCat("token: would travel in plain text to ",
                                                   options.server_address, ", wanted tls"));
  }
  if (options.tls.has_value() &&
      options.tls->certificate_chain.empty() != options.tls->private_key.empty()) {
    return absl::InvalidArgumentError(
        "tls: certificate_chain and private_key, wanted both or neither");
  }
  return absl::OkStatus();
}

std::shared_ptr<grpc::ChannelCredentials> Credentials(const ClientOptions& options) {
  if (!options.tls.has_value()) return grpc::InsecureChannelCredentials();
  grpc::SslCredentialsOptions ssl;
  ssl.pem_root_certs = options.tls->root_certificates;
  ssl.pem_cert_chain = options.tls->certificate_chain;
  ssl.pem_private_key = options.tls->private_key;
  return grpc::SslCredentials(ssl);
}

grpc::ChannelArguments Arguments(const ClientOptions& options) {
  grpc::ChannelArguments arguments;
  arguments.SetLoadBalancingPolicyName("round_robin");
  arguments.SetServiceConfigJSON(kServiceConfig);
  // A lost connection is tried again as soon as a call is, and often: gRPC's own waits grow to two
  // minutes, while the server has long been back.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS,
                   static_cast<int>(absl::ToInt64Milliseconds(options.retry.initial_backoff)));
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS,
                   static_cast<int>(absl::ToInt64Milliseconds(
                       std::max(options.retry.initial_backoff,
                                std::min(options.retry.max_backoff, kLongestReconnectWait)))));
  // gRPC's name for it is another, but this is the least time that it gives an attempt to connect.
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS,
                   static_cast<int>(absl::ToInt64Milliseconds(kConnectTimeout)));
  // Plain text to this machine must not take the way of the environment's proxy.
  if (!options.token.empty() && !options.tls.has_value()) {
    arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  }
  if (!options.authority.empty()) {
    arguments.SetString(GRPC_ARG_DEFAULT_AUTHORITY, options.authority);
  }
  if (options.own_connection) arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  if (options.tls.has_value() && !options.tls->server_name.empty()) {
    arguments.SetSslTargetNameOverride(options.tls->server_name);
  }
  return arguments;
}

// Waits as long as is asked, and looks after a lost connection meanwhile: between calls that fail
// at once nobody else does, but for gRPC's own look every five seconds.
RetryEnvironment LookingAfter(std::shared_ptr<grpc::Channel> channel) {
  RetryEnvironment environment = SystemEnvironment();
  environment.sleep = [channel = std::move(channel)](absl::Duration wait) {
    const absl::Time end = absl::Now() + wait;
    if (channel->GetState(false) != GRPC_CHANNEL_READY) {
      channel->WaitForConnected(absl::ToChronoTime(end));
    }
    absl::SleepFor(end - absl::Now());
  };
  return environment;
}

}  // namespace

std::string GrpcTarget(std::string_view server_address) {
  const std::string address(server_address);
  for (const char* scheme : {"dns:", "ipv4:", "ipv6:", "unix:", "unix-abstract:", "xds:"}) {
    if (absl::StartsWith(address, scheme)) return address;
  }
  return "dns:///" + address;
}

absl::StatusOr<std::shared_ptr<grpc::Channel>> OpenChannel(const ClientOptions& options) {
  absl::Status status = Check(options);
  if (!status.ok()) return status;
  return grpc::CreateCustomChannel(GrpcTarget(options.server_address), Credentials(options),
                                   Arguments(options));
}

absl::StatusOr<std::shared_ptr<Connection>> Connect(const ClientOptions& options) {
  absl::StatusOr<std::shared_ptr<grpc::Channel>> channel = OpenChannel(options);
  if (!channel.ok()) return channel.status();
  RetryEnvironment environment = LookingAfter(*channel);
  return std::make_shared<ConnectionImpl>(MakeGrpcStub(*std::move(channel), options.token), options,
                                          std::move(environment));
}

}  // namespace duet::client::internal
