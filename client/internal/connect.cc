#include "client/internal/connect.h"

#include <algorithm>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "client/internal/grpc_status.h"
#include "client/internal/live_session_impl.h"
#include "client/internal/proto_conversion.h"
#include "grpcpp/create_channel.h"
#include "grpcpp/security/credentials.h"
#include "grpcpp/support/channel_arguments.h"
#include "model/base/pem.h"

namespace duet::client::internal {
namespace {

// Distributes calls over all servers behind the name whose health service reports SERVING, so that
// a draining server gets no new calls. The empty service name stands for the server as a whole.
constexpr char kServiceConfig[] = R"({
  "loadBalancingConfig": [{"round_robin": {}}],
  "healthCheckConfig": {"serviceName": ""}
})";

constexpr absl::Duration kLongestReconnectWait = absl::Seconds(1);
// Maximum time of one connection attempt, including the handshake. gRPC's default of 20 s is too
// long if a firewall drops packets.
constexpr absl::Duration kConnectTimeout = absl::Seconds(5);

bool IsToken(absl::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return absl::ascii_isgraph(c); });
}

// Returns true if data sent to an address stays on this machine. A host name other than localhost
// can resolve to any machine.
bool IsThisMachine(absl::string_view address) {
  if (absl::StartsWith(address, "unix:") || absl::StartsWith(address, "unix-abstract:")) {
    return true;
  }
  for (const char* scheme : {"dns:///", "dns:", "ipv4:", "ipv6:"}) {
    if (absl::ConsumePrefix(&address, scheme)) break;
  }
  // A target with several addresses: treated as remote.
  if (absl::StrContains(address, ',')) return false;
  if (address == "[::1]" || absl::StartsWith(address, "[::1]:")) return true;
  const absl::string_view host = address.substr(0, address.find(':'));
  if (host == "localhost") return true;
  // Only digits and dots: "127.example.com" is a host name, not an address in 127.0.0.0/8.
  return absl::StartsWith(host, "127.") &&
         std::all_of(host.begin(), host.end(),
                     [](unsigned char c) { return absl::ascii_isdigit(c) || c == '.'; });
}

absl::Status Wrong(const std::string& name, absl::string_view expected, absl::string_view got) {
  return absl::InvalidArgumentError(absl::StrCat(name, ": expected ", expected, ", got ", got));
}

absl::Status Check(const ClientOptions& options) {
  const RetryOptions& retry = options.retry;
  if (options.server_address.empty()) {
    return Wrong("server_address", "host:port", "an empty string");
  }
  if (options.deadline <= absl::ZeroDuration()) {
    return Wrong("deadline", "more than 0", absl::FormatDuration(options.deadline));
  }
  if (options.wait < absl::ZeroDuration()) {
    return Wrong("wait", "0 or more", absl::FormatDuration(options.wait));
  }
  if (retry.max_attempts < 1) {
    return Wrong("retry.max_attempts", "1 or more", absl::StrCat(retry.max_attempts));
  }
  if (retry.initial_backoff <= absl::ZeroDuration() || retry.max_backoff < retry.initial_backoff) {
    return Wrong("retry", "0 < initial_backoff <= max_backoff",
                 absl::StrCat("initial_backoff ", absl::FormatDuration(retry.initial_backoff),
                              " and max_backoff ", absl::FormatDuration(retry.max_backoff)));
  }
  if (!IsToken(options.token)) {
    // The message does not contain the token, because messages are logged.
    return Wrong("token", "printable ASCII without spaces", "another character");
  }
  if (!options.token.empty() && !options.tls.has_value() &&
      !IsThisMachine(options.server_address)) {
    return Wrong("token", absl::StrCat("TLS to ", options.server_address), "plain text");
  }
  return options.tls.has_value() ? CheckTls(*options.tls) : absl::OkStatus();
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
  // Reconnect as often as calls are retried. gRPC's default backoff grows to two minutes, long
  // after the server is back.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS,
                   static_cast<int>(absl::ToInt64Milliseconds(options.retry.initial_backoff)));
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS,
                   static_cast<int>(absl::ToInt64Milliseconds(
                       std::max(options.retry.initial_backoff,
                                std::min(options.retry.max_backoff, kLongestReconnectWait)))));
  // Despite its name, this is also gRPC's timeout of one connection attempt.
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS,
                   static_cast<int>(absl::ToInt64Milliseconds(kConnectTimeout)));
  // Plain text to this machine must not go through the environment's proxy.
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

// Reconnects while a retry waits. Between calls that fail immediately, gRPC itself only checks the
// connection every five seconds.
RetryEnvironment ReconnectingEnvironment(std::shared_ptr<grpc::Channel> channel) {
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

absl::Status CheckOwnCertificate(const TlsOptions& tls, const TlsNames& names) {
  const std::vector<base::Certificate> chain = base::ReadCertificates(tls.certificate_chain);
  if (chain.empty()) {
    return Wrong(names.certificate_chain, "PEM certificates, this client's own first", "none");
  }
  const base::PrivateKey key = base::ReadPrivateKey(tls.private_key);
  if (key == nullptr) {
    return Wrong(names.private_key, "a private key in PEM without a password", "none");
  }
  if (base::IsKeyOf(chain.front(), key)) return absl::OkStatus();
  return Wrong(names.private_key,
               absl::StrCat("the key of the first certificate in ", names.certificate_chain),
               "another certificate's key");
}

// Makes a retry use the model version that produced the frames already handed out, so that all
// frames of a follower come from the same version.
void PinModel(const v1::SynthesisHeader& answered, v1::ModelSelector* selector) {
  selector->set_name(answered.model_name());
  selector->set_version(answered.model_version());
}

absl::Status ModelIsGone(const absl::Status& status, const v1::ModelSelector& pinned, int frames) {
  return WithPayloadsOf(
      status, absl::AbortedError(absl::StrCat("the stream broke after ", frames,
                                              " frames and cannot be resumed: ", pinned.name(), "@",
                                              pinned.version(), " is no longer served")));
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
  RetryEnvironment environment = ReconnectingEnvironment(*channel);
  return std::make_shared<ConnectionImpl>(*channel, options, std::move(environment));
}

absl::Status CheckTls(const TlsOptions& tls, const TlsNames& names) {
  if (tls.certificate_chain.empty() != tls.private_key.empty()) {
    return absl::InvalidArgumentError(
        "tls: expected certificate_chain and private_key or neither, got one of the two");
  }
  if (!tls.root_certificates.empty() && base::ReadCertificates(tls.root_certificates).empty()) {
    return Wrong(names.root_certificates, "PEM certificates", "none");
  }
  return tls.certificate_chain.empty() ? absl::OkStatus() : CheckOwnCertificate(tls, names);
}

ConnectionImpl::ConnectionImpl(const std::shared_ptr<grpc::Channel>& channel,
                               const ClientOptions& options, RetryEnvironment environment)
    : stub_(v1::MotionSynthesis::NewStub(channel)),
      options_(options),
      environment_(std::move(environment)) {}

ConnectionImpl::~ConnectionImpl() {
  std::unique_lock<std::mutex> lock(mutex_);
  none_in_progress_.wait(lock, [this] { return in_progress_ == 0; });
}

template <typename Request, typename Response>
absl::StatusOr<Response> ConnectionImpl::Call(grpc::Status (Stub::*method)(grpc::ClientContext*,
                                                                           const Request&,
                                                                           Response*),
                                              const Request& request) {
  const absl::Time deadline = environment_.now() + options_.deadline;
  Response response;
  absl::Status status =
      Retry(options_.retry, environment_, Priority::kInteractive,
            {deadline, options_.wait, options_.server_address}, [&] {
              const auto context = NewContext(deadline, options_.token);
              return FromGrpc(((*stub_).*method)(context.get(), request, &response));
            });
  if (!status.ok()) return status;
  return response;
}

absl::StatusOr<std::vector<ModelInfo>> ConnectionImpl::ListModels() {
  const absl::StatusOr<v1::ListModelsResponse> response =
      Call(&Stub::ListModels, v1::ListModelsRequest());
  if (!response.ok()) return response.status();
  std::vector<ModelInfo> models;
  for (const v1::Model& model : response->models()) {
    absl::StatusOr<ModelInfo> info = FromProto(model);
    if (!info.ok()) return info.status();
    models.push_back(*std::move(info));
  }
  return models;
}

absl::StatusOr<ModelDetails> ConnectionImpl::GetModel(const ModelChoice& choice) {
  absl::StatusOr<v1::ModelSelector> selector = ToProto(choice);
  if (!selector.ok()) return selector.status();
  v1::GetModelRequest request;
  *request.mutable_model() = *std::move(selector);
  const absl::StatusOr<v1::GetModelResponse> response = Call(&Stub::GetModel, request);
  if (!response.ok()) return response.status();
  absl::StatusOr<ModelInfo> model = FromProto(response->model());
  if (!model.ok()) return model.status();
  return ModelDetails{*std::move(model), FromProto(response->limits())};
}

absl::StatusOr<SynthesisResult> ConnectionImpl::Synthesize(const SynthesisRequest& request,
                                                           const ChunkCallback& on_chunk) {
  return Synthesize(request, on_chunk, options_.retry);
}

void ConnectionImpl::SynthesizeAsync(SynthesisRequest request, const SynthesisCallback& done) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++in_progress_;
  }
  RetryOptions once = options_.retry;
  once.max_attempts = 1;
  std::thread([this, request = std::move(request), done, once = std::move(once)] {
    done(Synthesize(request, nullptr, once));
    const std::lock_guard<std::mutex> lock(mutex_);
    if (--in_progress_ == 0) none_in_progress_.notify_all();
  }).detach();
}

absl::StatusOr<std::unique_ptr<LiveSession>> ConnectionImpl::StartLive(const LiveRequest& request,
                                                                       LiveCallbacks callbacks) {
  return LiveSessionImpl::Start(stub_, request, std::move(callbacks), {options_, environment_});
}

absl::StatusOr<SynthesisResult> ConnectionImpl::Synthesize(const SynthesisRequest& request,
                                                           const ChunkCallback& on_chunk,
                                                           const RetryOptions& retry) {
  absl::Status valid = CheckRequestId(request.request_id);
  if (!valid.ok()) return valid;
  absl::StatusOr<v1::SynthesizeRequest> wire = ToProto(request);
  if (!wire.ok()) return wire.status();
  const absl::Time start = environment_.now();
  const absl::Time deadline = start + options_.deadline;
  ReplyAssembler reply(request.leader, on_chunk, request.rotations,
                       static_cast<int>(request.constraints.size()));
  absl::Time first_chunk = absl::InfiniteFuture();
  int attempts = 0;
  const auto attempt = [&]() -> AttemptEnd {
    ++attempts;
    const bool resumes = reply.handed_out() > 0;
    if (resumes && reply.header().has_value()) PinModel(*reply.header(), wire->mutable_model());
    const int handed_out = reply.handed_out();
    const auto context = NewContext(deadline, options_.token, request.request_id);
    absl::Status ended = RunStream(context.get(), *wire, &reply, &first_chunk);
    if (resumes && absl::IsNotFound(ended)) return ModelIsGone(ended, wire->model(), handed_out);
    // An error from the callback ends the call; it is never retried.
    if (!reply.callback_status().ok()) return absl::OkStatus();
    return {std::move(ended), reply.header().has_value()};
  };
  absl::Status status = Retry(retry, environment_, request.priority,
                              {deadline, options_.wait, options_.server_address}, attempt);
  if (!reply.callback_status().ok()) return reply.callback_status();
  if (!status.ok()) return status;
  SynthesisResult result = std::move(reply).TakeResult();
  result.attempt_count = attempts;
  result.timings.first_chunk = first_chunk - start;
  result.timings.total = environment_.now() - start;
  return result;
}

absl::Status ConnectionImpl::RunStream(grpc::ClientContext* context,
                                       const v1::SynthesizeRequest& request, ReplyAssembler* reply,
                                       absl::Time* first_chunk) {
  reply->StartStream();
  const auto stream = stub_->Synthesize(context, request);
  v1::SynthesizeResponse response;
  absl::Status accepted;
  while (stream->Read(&response)) {
    if (!accepted.ok()) continue;  // cancelled; drop what still arrives
    const absl::Time arrival = environment_.now();
    accepted = reply->Accept(response);
    if (!accepted.ok()) context->TryCancel();
    if (reply->has_frames()) *first_chunk = std::min(*first_chunk, arrival);
  }
  const absl::Status ended = FromGrpc(stream->Finish());
  return accepted.ok() ? reply->EndStream(ended) : accepted;
}

}  // namespace duet::client::internal
