#include "client/internal/connection_impl.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/internal/grpc_status.h"
#include "client/internal/live_session_impl.h"
#include "client/internal/proto_conversion.h"

namespace duet::client::internal {
namespace {

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

// INVALID_ARGUMENT, naming the field, for values that neither the message nor the metadata of a
// call can carry.
absl::StatusOr<v1::SynthesizeRequest> ToWire(const SynthesisRequest& request) {
  absl::Status status = CheckRequestId(request.request_id);
  if (!status.ok()) return status;
  return ToProto(request);
}

// Assembles the reply of an asynchronous call.
class ReplyListener final : public StreamListener {
 public:
  ReplyListener(SynthesisRequest request, std::string server_address, SynthesisCallback done,
                std::function<absl::Time()> now)
      : request_(std::move(request)),
        server_address_(std::move(server_address)),
        done_(std::move(done)),
        now_(std::move(now)),
        start_(now_()),
        reply_(request_.leader, no_callback_, request_.rotations,
               static_cast<int>(request_.constraints.size())) {
    reply_.StartStream();
  }

  bool OnMessage(const v1::SynthesizeResponse& response) override {
    accepted_ = reply_.Accept(response);
    if (reply_.has_frames() && first_chunk_ == absl::InfiniteFuture()) first_chunk_ = now_();
    return accepted_.ok();
  }

  void OnEnd(const absl::Status& status) override {
    const absl::Status ended = accepted_.ok() ? reply_.EndStream(status) : accepted_;
    if (!ended.ok()) return done_(Explained({ended, reply_.header().has_value()}, server_address_));
    SynthesisResult result = std::move(reply_).TakeResult();
    result.attempt_count = 1;
    result.timings.first_chunk = first_chunk_ - start_;
    result.timings.total = now_() - start_;
    done_(std::move(result));
  }

 private:
  const SynthesisRequest request_;
  const std::string server_address_;
  const SynthesisCallback done_;
  const std::function<absl::Time()> now_;
  const absl::Time start_;
  absl::Time first_chunk_ = absl::InfiniteFuture();
  const ChunkCallback no_callback_;
  ReplyAssembler reply_;
  absl::Status accepted_;
};

}  // namespace

ConnectionImpl::ConnectionImpl(std::shared_ptr<Stub> stub, const ClientOptions& options,
                               RetryEnvironment environment)
    : stub_(std::move(stub)),
      deadline_(options.deadline),
      wait_(options.wait),
      server_address_(options.server_address),
      retry_(options.retry),
      environment_(std::move(environment)) {}

RetryLimits ConnectionImpl::Limits(const CallContext& call) const {
  return {call.deadline, wait_, server_address_};
}

absl::StatusOr<std::vector<ModelInfo>> ConnectionImpl::ListModels() {
  const CallContext call{Deadline(), ""};
  absl::StatusOr<v1::ListModelsResponse> response;
  absl::Status status = Retry(retry_, environment_, Priority::kInteractive, Limits(call), [&] {
    response = stub_->ListModels(call, {});
    return response.status();
  });
  if (!status.ok()) return status;
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
  const CallContext call{Deadline(), ""};
  absl::StatusOr<v1::GetModelResponse> response;
  absl::Status status = Retry(retry_, environment_, Priority::kInteractive, Limits(call), [&] {
    response = stub_->GetModel(call, request);
    return response.status();
  });
  if (!status.ok()) return status;
  absl::StatusOr<ModelInfo> model = FromProto(response->model());
  if (!model.ok()) return model.status();
  return ModelDetails{*std::move(model), FromProto(response->limits())};
}

absl::StatusOr<SynthesisResult> ConnectionImpl::Synthesize(const SynthesisRequest& request,
                                                           const ChunkCallback& on_chunk) {
  absl::StatusOr<v1::SynthesizeRequest> wire = ToWire(request);
  if (!wire.ok()) return wire.status();
  const absl::Time start = environment_.now();
  const CallContext call{start + deadline_, request.request_id};
  ReplyAssembler reply(request.leader, on_chunk, request.rotations,
                       static_cast<int>(request.constraints.size()));
  absl::Time first_chunk = absl::InfiniteFuture();
  int attempts = 0;
  absl::Status status =
      Retry(retry_, environment_, request.priority, Limits(call), [&]() -> AttemptEnd {
        ++attempts;
        const bool resumes = reply.handed_out() > 0;
        if (resumes && reply.header().has_value()) PinModel(*reply.header(), wire->mutable_model());
        const int handed_out = reply.handed_out();
        absl::Status ended = RunStream(call, *wire, &reply, &first_chunk);
        if (resumes && absl::IsNotFound(ended))
          return ModelIsGone(ended, wire->model(), handed_out);
        // An error from the callback ends the call; it is never retried.
        if (!reply.callback_status().ok()) return absl::OkStatus();
        return {std::move(ended), reply.header().has_value()};
      });
  if (!reply.callback_status().ok()) return reply.callback_status();
  if (!status.ok()) return status;
  SynthesisResult result = std::move(reply).TakeResult();
  result.attempt_count = attempts;
  result.timings.first_chunk = first_chunk - start;
  result.timings.total = environment_.now() - start;
  return result;
}

void ConnectionImpl::SynthesizeAsync(SynthesisRequest request, const SynthesisCallback& done) {
  const absl::StatusOr<v1::SynthesizeRequest> wire = ToWire(request);
  if (!wire.ok()) return done(wire.status());
  const CallContext call{Deadline(), request.request_id};
  stub_->Start(
      call, *wire,
      std::make_unique<ReplyListener>(std::move(request), server_address_, done, environment_.now));
}

absl::StatusOr<std::unique_ptr<LiveSession>> ConnectionImpl::StartLive(const LiveRequest& request,
                                                                       LiveCallbacks callbacks) {
  return LiveSessionImpl::Start(stub_, request, std::move(callbacks),
                                {deadline_, wait_, server_address_, retry_, environment_});
}

absl::Status ConnectionImpl::RunStream(const CallContext& call,
                                       const v1::SynthesizeRequest& request, ReplyAssembler* reply,
                                       absl::Time* first_chunk) {
  reply->StartStream();
  std::unique_ptr<ResponseStream> stream = stub_->Synthesize(call, request);
  v1::SynthesizeResponse response;
  absl::Status accepted;
  while (stream->Read(&response)) {
    if (!accepted.ok()) continue;  // cancelled; drop what still arrives
    const absl::Time arrival = environment_.now();
    accepted = reply->Accept(response);
    if (!accepted.ok()) stream->Cancel();
    if (reply->has_frames()) *first_chunk = std::min(*first_chunk, arrival);
  }
  const absl::Status ended = stream->Finish();
  return accepted.ok() ? reply->EndStream(ended) : accepted;
}

}  // namespace duet::client::internal
