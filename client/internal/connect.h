#ifndef DUET_CLIENT_INTERNAL_CONNECT_H_
#define DUET_CLIENT_INTERNAL_CONNECT_H_

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/connection.h"
#include "client/internal/reply_assembler.h"
#include "client/internal/retry.h"
#include "client/options.h"
#include "duet/v1/synthesis.grpc.pb.h"
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

// Makes calls over a channel: converts values to protos and back, sets the deadline, retries, and
// validates the replies.
class ConnectionImpl final : public Connection {
 public:
  ConnectionImpl(const std::shared_ptr<grpc::Channel>& channel, const ClientOptions& options,
                 RetryEnvironment environment);
  ConnectionImpl(const ConnectionImpl&) = delete;
  ConnectionImpl& operator=(const ConnectionImpl&) = delete;
  // Waits for the calls of SynthesizeAsync.
  ~ConnectionImpl() override;

  absl::StatusOr<std::vector<ModelInfo>> ListModels() override;
  absl::StatusOr<ModelDetails> GetModel(const ModelChoice& choice) override;
  absl::StatusOr<SynthesisResult> Synthesize(const SynthesisRequest& request,
                                             const ChunkCallback& on_chunk) override;
  void SynthesizeAsync(SynthesisRequest request, const SynthesisCallback& done) override;
  absl::StatusOr<std::unique_ptr<LiveSession>> StartLive(const LiveRequest& request,
                                                         LiveCallbacks callbacks) override;

 private:
  using Stub = v1::MotionSynthesis::Stub;

  // Calls a method that answers with one message.
  template <typename Request, typename Response>
  absl::StatusOr<Response> Call(grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&,
                                                             Response*),
                                const Request& request);
  absl::StatusOr<SynthesisResult> Synthesize(const SynthesisRequest& request,
                                             const ChunkCallback& on_chunk,
                                             const RetryOptions& retry);
  absl::Status RunStream(grpc::ClientContext* context, const v1::SynthesizeRequest& request,
                         ReplyAssembler* reply, absl::Time* first_chunk);

  const std::shared_ptr<Stub> stub_;
  const ClientOptions options_;
  const RetryEnvironment environment_;

  std::mutex mutex_;
  std::condition_variable none_in_progress_;
  int in_progress_ = 0;  // calls of SynthesizeAsync
};

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_CONNECT_H_
