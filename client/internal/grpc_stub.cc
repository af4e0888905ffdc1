#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "client/internal/grpc_status.h"
#include "client/internal/stub.h"
#include "duet/v1/synthesis.grpc.pb.h"
#include "grpcpp/client_context.h"
#include "grpcpp/support/client_callback.h"
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

class GrpcLiveStream final : public LiveStream {
 public:
  GrpcLiveStream(v1::MotionSynthesis::Stub& stub, const CallContext& call,
                 const std::string& authorization) {
    Prepare(call, authorization, &context_);
    stream_ = stub.SynthesizeLive(&context_);
  }

  bool Write(const v1::SynthesizeLiveRequest& request) override { return stream_->Write(request); }
  bool WritesDone() override { return stream_->WritesDone(); }
  bool Read(v1::SynthesizeLiveResponse* response) override { return stream_->Read(response); }
  void Cancel() override { context_.TryCancel(); }
  absl::Status Finish() override { return FromGrpc(stream_->Finish()); }

 private:
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::SynthesizeLiveRequest, v1::SynthesizeLiveResponse>>
      stream_;
};

// Counts the streams in progress.
//
// Threads: safe to call concurrently.
class UnderWay {
 public:
  void Begin() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++count_;
  }
  void End() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (--count_ == 0) none_.notify_all();
  }
  void WaitUntilNone() {
    std::unique_lock<std::mutex> lock(mutex_);
    none_.wait(lock, [this] { return count_ == 0; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable none_;
  int count_ = 0;
};

// A stream that gRPC's own threads read. Deletes itself at its end.
class ListenedStream final : public grpc::ClientReadReactor<v1::SynthesizeResponse> {
 public:
  ListenedStream(const CallContext& call, const std::string& authorization,
                 std::unique_ptr<StreamListener> listener, UnderWay* under_way)
      : listener_(std::move(listener)), under_way_(under_way) {
    Prepare(call, authorization, &context_);
  }

  void Start(v1::MotionSynthesis::Stub& stub, const v1::SynthesizeRequest& request) {
    under_way_->Begin();
    stub.async()->Synthesize(&context_, &request, this);
    StartRead(&response_);
    StartCall();
  }

  void OnReadDone(bool ok) override {
    if (!ok) return;
    if (wanted_ && !listener_->OnMessage(response_)) {
      wanted_ = false;
      context_.TryCancel();
    }
    StartRead(&response_);
  }

  void OnDone(const grpc::Status& status) override {
    listener_->OnEnd(FromGrpc(status));
    UnderWay* const under_way = under_way_;
    delete this;
    under_way->End();
  }

 private:
  grpc::ClientContext context_;
  std::unique_ptr<StreamListener> listener_;
  UnderWay* const under_way_;
  v1::SynthesizeResponse response_;
  bool wanted_ = true;
};

class GrpcStub final : public Stub {
 public:
  GrpcStub(std::shared_ptr<grpc::Channel> channel, const std::string& token)
      : stub_(v1::MotionSynthesis::NewStub(std::move(channel))),
        authorization_(token.empty() ? "" : "Bearer " + token) {}
  GrpcStub(const GrpcStub&) = delete;
  GrpcStub& operator=(const GrpcStub&) = delete;
  ~GrpcStub() override { under_way_.WaitUntilNone(); }

  absl::StatusOr<v1::ListModelsResponse> ListModels(const CallContext& call,
                                                    const v1::ListModelsRequest& request) override {
    return Call(&v1::MotionSynthesis::Stub::ListModels, call, request, v1::ListModelsResponse());
  }

  absl::StatusOr<v1::GetModelResponse> GetModel(const CallContext& call,
                                                const v1::GetModelRequest& request) override {
    return Call(&v1::MotionSynthesis::Stub::GetModel, call, request, v1::GetModelResponse());
  }

  std::unique_ptr<ResponseStream> Synthesize(const CallContext& call,
                                             const v1::SynthesizeRequest& request) override {
    return std::make_unique<GrpcResponseStream>(*stub_, call, authorization_, request);
  }

  void Start(const CallContext& call, const v1::SynthesizeRequest& request,
             std::unique_ptr<StreamListener> listener) override {
    // Deletes itself.
    (new ListenedStream(call, authorization_, std::move(listener), &under_way_))
        ->Start(*stub_, request);
  }

  std::unique_ptr<LiveStream> SynthesizeLive(const CallContext& call) override {
    return std::make_unique<GrpcLiveStream>(*stub_, call, authorization_);
  }

 private:
  template <typename Request, typename Response>
  absl::StatusOr<Response> Call(grpc::Status (v1::MotionSynthesis::Stub::*method)(
                                    grpc::ClientContext*, const Request&, Response*),
                                const CallContext& call, const Request& request,
                                Response response) {
    grpc::ClientContext context;
    Prepare(call, authorization_, &context);
    absl::Status status = FromGrpc(((*stub_).*method)(&context, request, &response));
    if (!status.ok()) return status;
    return response;
  }

  std::unique_ptr<v1::MotionSynthesis::Stub> stub_;
  const std::string authorization_;
  UnderWay under_way_;
};

}  // namespace

std::shared_ptr<Stub> MakeGrpcStub(std::shared_ptr<grpc::Channel> channel,
                                   const std::string& token) {
  return std::make_shared<GrpcStub>(std::move(channel), token);
}

}  // namespace duet::client::internal
