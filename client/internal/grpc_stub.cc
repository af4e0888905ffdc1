#include "client/internal/grpc_stub.h"

#include <string>
#include <utility>

#include "client/internal/grpc_status.h"
#include "duet/v1/synthesis.grpc.pb.h"
#include "grpcpp/client_context.h"
#include "grpcpp/support/sync_stream.h"

namespace duet::client::internal {
namespace {

// `authorization`: a whole "Bearer TOKEN", or empty.
void Prepare(const CallContext& call, const std::string& authorization,
             grpc::ClientContext* context) {
  context->set_deadline(absl::ToChronoTime(call.deadline));
  if (!authorization.empty()) context->AddMetadata("authorization", authorization);
  if (!call.request_id.empty()) context->AddMetadata("x-request-id", call.request_id);
}

class GrpcResponseStream final : public ResponseStream {
 public:
  GrpcResponseStream(v1::MotionSynthesis::Stub& stub, const CallContext& call,
                     const std::string& authorization, const v1::SynthesizeRequest& request) {
    Prepare(call, authorization, &context_);
    reader_ = stub.Synthesize(&context_, request);
  }

  bool Read(v1::SynthesizeResponse* response) override { return reader_->Read(response); }
  void Cancel() override { context_.TryCancel(); }
  absl::Status Finish() override { return FromGrpc(reader_->Finish()); }

 private:
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReader<v1::SynthesizeResponse>> reader_;
};

class GrpcStub final : public Stub {
 public:
  GrpcStub(std::shared_ptr<grpc::Channel> channel, const std::string& token)
      : stub_(v1::MotionSynthesis::NewStub(std::move(channel))),
        authorization_(token.empty() ? "" : "Bearer " + token) {}

  absl::StatusOr<v1::ListModelsResponse> ListModels(const CallContext& call,
                                                    const v1::ListModelsRequest& request) override {
    grpc::ClientContext context;
    Prepare(call, authorization_, &context);
    v1::ListModelsResponse response;
    absl::Status status = FromGrpc(stub_->ListModels(&context, request, &response));
    if (!status.ok()) return status;
    return response;
  }

  absl::StatusOr<v1::GetModelResponse> GetModel(const CallContext& call,
                                                const v1::GetModelRequest& request) override {
    grpc::ClientContext context;
    Prepare(call, authorization_, &context);
    v1::GetModelResponse response;
    absl::Status status = FromGrpc(stub_->GetModel(&context, request, &response));
    if (!status.ok()) return status;
    return response;
  }

  std::unique_ptr<ResponseStream> Synthesize(const CallContext& call,
                                             const v1::SynthesizeRequest& request) override {
    return std::make_unique<GrpcResponseStream>(*stub_, call, authorization_, request);
  }

 private:
  std::unique_ptr<v1::MotionSynthesis::Stub> stub_;
  const std::string authorization_;
};

}  // namespace

std::shared_ptr<Stub> MakeGrpcStub(std::shared_ptr<grpc::Channel> channel,
                                   const std::string& token) {
  return std::make_shared<GrpcStub>(std::move(channel), token);
}

}  // namespace duet::client::internal
