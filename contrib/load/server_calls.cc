#include "contrib/load/server_calls.h"

#include <chrono>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/time/time.h"
#include "client/internal/connect.h"
#include "client/internal/proto_conversion.h"
#include "contrib/load/inbox.h"
#include "duet/v1/synthesis.pb.h"
#include "grpcpp/client_context.h"
#include "grpcpp/generic/generic_stub.h"
#include "grpcpp/impl/codegen/proto_utils.h"
#include "grpcpp/support/byte_buffer.h"
#include "grpcpp/support/client_callback.h"
#include "grpcpp/support/slice.h"
#include "model/motion/clip.h"

namespace duet::contrib::load {
namespace {

constexpr char kMethod[] = "/duet.v1.MotionSynthesis/Synthesize";

// Sends requests as bytes that were serialised once.
using Stub = grpc::TemplatedGenericStub<grpc::ByteBuffer, v1::SynthesizeResponse>;

// Whether the server rejects a call because of its content.
absl::Status Try(const client::Client& client, const client::SynthesisRequest& request) {
  const auto enough = [](const client::FollowerChunk&) { return absl::CancelledError("enough"); };
  const absl::Status status = client.SynthesizeStreaming(request, enough).status();
  switch (status.code()) {
    case absl::StatusCode::kCancelled:
    case absl::StatusCode::kResourceExhausted:
    case absl::StatusCode::kDeadlineExceeded:
      return absl::OkStatus();
    default:
      return status;
  }
}

// One call. gRPC's threads report each message; it records times and counts frames.
class Call final : public grpc::ClientBidiReactor<grpc::ByteBuffer, v1::SynthesizeResponse> {
 public:
  // `request` and `inbox` outlive the call.
  static void Begin(int64_t id, Stub& stub, const grpc::ByteBuffer* request,
                    const std::string& authorization, absl::Duration deadline,
                    Inbox<EndedCall>* inbox) {
    auto* const call = new Call(id, inbox);  // until OnDone
    grpc::ClientContext& context = call->context_;
    context.set_deadline(std::chrono::system_clock::now() + absl::ToChronoMicroseconds(deadline));
    if (!authorization.empty()) context.AddMetadata("authorization", authorization);
    inbox->Opened();
    stub.PrepareBidiStreamingCall(&context, kMethod, {}, call);
    call->StartWriteLast(request, {});
    call->StartRead(&call->response_);
    call->StartCall();
  }

  void OnReadDone(bool ok) override {
    if (!ok) return;
    if (response_.has_header()) wanted_ = static_cast<int>(response_.header().frame_count());
    if (response_.has_chunk()) {
      if (ended_.frames == 0) ended_.first_chunk = std::chrono::steady_clock::now();
      ended_.frames += static_cast<int>(response_.chunk().frame_count());
    }
    if (response_.has_summary()) summed_up_ = true;
    StartRead(&response_);
  }

  void OnDone(const grpc::Status& status) override {
    EndedCall ended = ended_;
    ended.end = std::chrono::steady_clock::now();
    ended.code = static_cast<absl::StatusCode>(status.error_code());
    const bool complete = summed_up_ && ended.frames == wanted_;
    if (status.ok() && !complete) ended.code = absl::StatusCode::kInternal;
    // Release the call first. It holds a connection, and gRPC's thread must not release the last
    // reference to one, because closing it waits for that thread.
    Inbox<EndedCall>* const inbox = inbox_;
    delete this;
    inbox->Add(ended, true);
  }

 private:
  Call(int64_t id, Inbox<EndedCall>* inbox) : inbox_(inbox) { ended_.id = id; }

  Inbox<EndedCall>* const inbox_;
  grpc::ClientContext context_;
  v1::SynthesizeResponse response_;
  EndedCall ended_;
  int wanted_ = 0;
  bool summed_up_ = false;
};

class ServerCalls final : public CallTarget {
 public:
  ServerCalls(const std::vector<std::shared_ptr<grpc::Channel>>& channels,
              const std::string& request, const client::ClientOptions& options)
      : authorization_(options.token.empty() ? "" : absl::StrCat("Bearer ", options.token)),
        deadline_(options.deadline) {
    for (const auto& channel : channels) stubs_.emplace_back(channel);
    const grpc::Slice slice(request);
    request_ = grpc::ByteBuffer(&slice, 1);
  }
  ServerCalls(const ServerCalls&) = delete;
  ServerCalls& operator=(const ServerCalls&) = delete;
  ~ServerCalls() override { inbox_.WaitUntilNoneIsOpen(); }

  Time Now() const override { return std::chrono::steady_clock::now(); }
  void Start(int64_t id) override {
    Stub& stub = stubs_[static_cast<std::size_t>(id) % stubs_.size()];
    Call::Begin(id, stub, &request_, authorization_, deadline_, &inbox_);
  }
  std::vector<EndedCall> Wait(Time until) override { return inbox_.Wait(until); }

 private:
  const std::string authorization_;
  const absl::Duration deadline_;
  std::vector<Stub> stubs_;
  grpc::ByteBuffer request_;
  Inbox<EndedCall> inbox_;
};

}  // namespace

absl::StatusOr<std::vector<std::shared_ptr<grpc::Channel>>> OpenChannels(
    const client::ClientOptions& options, int connections) {
  client::ClientOptions own = options;
  own.own_connection = true;
  std::vector<std::shared_ptr<grpc::Channel>> channels;
  const auto end = std::chrono::system_clock::now() + absl::ToChronoMicroseconds(options.deadline);
  for (int i = 0; i < connections; ++i) {
    absl::StatusOr<std::shared_ptr<grpc::Channel>> channel = client::internal::OpenChannel(own);
    if (!channel.ok()) return channel.status();
    (*channel)->GetState(true);
    channels.push_back(*std::move(channel));
  }
  for (const auto& channel : channels) {
    if (channel->WaitForConnected(end)) continue;
    return absl::UnavailableError(absl::StrCat("no connection to ", options.server_address,
                                               " within ", absl::FormatDuration(options.deadline)));
  }
  return channels;
}

motion::Vec3 SwayingJoint(int frame, int joint) {
  const float phase = 0.2F * static_cast<float>(frame) + static_cast<float>(joint);
  return {0.2F * std::sin(phase), 0.1F * static_cast<float>(joint), 0.2F * std::cos(phase)};
}

absl::StatusOr<CallRequest> FindRequest(const client::Client& client, const CallContent& content) {
  const absl::StatusOr<client::ModelDetails> details = client.GetModel(content.model);
  if (!details.ok()) return details.status();
  const client::ModelInfo& model = details->model;
  client::SynthesisRequest request;
  request.model = content.model;
  request.leader.joint_names = model.joint_names;
  request.leader.frame_rate_hz = model.frame_rate_hz;
  request.leader.poses = motion::Poses(content.frames, request.leader.joint_count());
  for (int t = 0; t < content.frames; ++t) {
    for (int j = 0; j < request.leader.joint_count(); ++j) {
      request.leader.at(t, j) = SwayingJoint(t, j);
    }
  }
  request.weights = content.labels;
  if (request.weights.empty()) request.weights = {{model.interaction_classes.front(), 1}};
  const absl::StatusOr<v1::SynthesizeRequest> wire = client::internal::ToProto(request);
  if (!wire.ok()) return wire.status();
  if (absl::Status status = Try(client, request); !status.ok()) return status;
  return CallRequest{absl::StrCat(model.name, "@", model.version), wire->SerializeAsString()};
}

absl::StatusOr<std::unique_ptr<CallTarget>> ConnectCalls(const client::ClientOptions& options,
                                                         int connections,
                                                         const std::string& request) {
  const auto channels = OpenChannels(options, connections);
  if (!channels.ok()) return channels.status();
  return std::make_unique<ServerCalls>(*channels, request, options);
}

}  // namespace duet::contrib::load
