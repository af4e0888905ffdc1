#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "client/internal/grpc_status.h"
#include "client/internal/stub.h"
#include "duet/v1/synthesis.grpc.pb.h"
#include "grpcpp/client_context.h"
#include "grpcpp/completion_queue.h"
#include "grpcpp/support/async_stream.h"
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

// A stream in progress. Each event of its completion queue makes it take one step.
class ListenedStream {
 public:
  ListenedStream(v1::MotionSynthesis::Stub& stub, const CallContext& call,
                 const std::string& authorization, const v1::SynthesizeRequest& request,
                 std::unique_ptr<StreamListener> listener, grpc::CompletionQueue* queue)
      : listener_(std::move(listener)) {
    Prepare(call, authorization, &context_);
    reader_ = stub.PrepareAsyncSynthesize(&context_, request, queue);
    reader_->StartCall(this);
  }

  // `ok`: the previous operation succeeded. Returns false when the stream is over.
  bool Step(bool ok) {
    switch (state_) {
      case State::kStarting:
        state_ = ok ? State::kReading : State::kFinishing;
        break;
      case State::kReading:
        if (!ok) state_ = State::kFinishing;
        if (ok && wanted_ && !listener_->OnMessage(response_)) {
          wanted_ = false;
          context_.TryCancel();
        }
        break;
      case State::kFinishing:
        listener_->OnEnd(FromGrpc(status_));
        return false;
    }
    if (state_ == State::kReading) {
      reader_->Read(&response_, this);
    } else {
      reader_->Finish(&status_, this);
    }
    return true;
  }

 private:
  enum class State { kStarting, kReading, kFinishing };

  grpc::ClientContext context_;
  std::unique_ptr<StreamListener> listener_;
  std::unique_ptr<grpc::ClientAsyncReader<v1::SynthesizeResponse>> reader_;
  v1::SynthesizeResponse response_;
  grpc::Status status_;
  State state_ = State::kStarting;
  bool wanted_ = true;
};

// A completion queue and the thread that processes its events. One thread serves many calls,
// because a thread for each call would wake up for each message. The destructor waits for calls in
// progress.
class StreamThread {
 public:
  StreamThread() : thread_([this] { Run(); }) {}
  StreamThread(const StreamThread&) = delete;
  StreamThread& operator=(const StreamThread&) = delete;
  ~StreamThread() {
    {
      // No operation may be started on a queue after its shutdown.
      std::unique_lock<std::mutex> lock(mutex_);
      none_under_way_.wait(lock, [this] { return under_way_ == 0; });
    }
    queue_.Shutdown();
    thread_.join();
  }

  void Start(v1::MotionSynthesis::Stub& stub, const CallContext& call,
             const std::string& authorization, const v1::SynthesizeRequest& request,
             std::unique_ptr<StreamListener> listener) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++under_way_;
    }
    // Run deletes it after its last step.
    new ListenedStream(stub, call, authorization, request, std::move(listener), &queue_);
  }

 private:
  void Run() {
    void* tag = nullptr;
    for (bool ok = false; queue_.Next(&tag, &ok);) {
      std::unique_ptr<ListenedStream> stream(static_cast<ListenedStream*>(tag));
      if (stream->Step(ok)) {
        (void)stream.release();  // its next event is in the queue
        continue;
      }
      stream.reset();
      const std::lock_guard<std::mutex> lock(mutex_);
      if (--under_way_ == 0) none_under_way_.notify_all();
    }
  }

  grpc::CompletionQueue queue_;
  std::mutex mutex_;
  std::condition_variable none_under_way_;
  int under_way_ = 0;
  std::thread thread_;  // last: it uses all of the above
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

  void Start(const CallContext& call, const v1::SynthesizeRequest& request,
             std::unique_ptr<StreamListener> listener) override {
    std::call_once(first_start_, [this] { streams_ = std::make_unique<StreamThread>(); });
    streams_->Start(*stub_, call, authorization_, request, std::move(listener));
  }

  std::unique_ptr<LiveStream> SynthesizeLive(const CallContext& call) override {
    return std::make_unique<GrpcLiveStream>(*stub_, call, authorization_);
  }

 private:
  std::unique_ptr<v1::MotionSynthesis::Stub> stub_;
  const std::string authorization_;
  std::once_flag first_start_;
  std::unique_ptr<StreamThread> streams_;
};

}  // namespace

std::shared_ptr<Stub> MakeGrpcStub(std::shared_ptr<grpc::Channel> channel,
                                   const std::string& token) {
  return std::make_shared<GrpcStub>(std::move(channel), token);
}

}  // namespace duet::client::internal
