#ifndef DUET_CLIENT_INTERNAL_STUB_H_
#define DUET_CLIENT_INTERNAL_STUB_H_

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "duet/v1/live.pb.h"
#include "duet/v1/synthesis.pb.h"
#include "grpcpp/channel.h"

namespace duet::client::internal {

// What one attempt of a call carries besides its request.
struct CallContext {
  absl::Time deadline;
  std::string request_id;  // may be empty
};

// A response stream in progress. Not safe to call concurrently.
class ResponseStream {
 public:
  virtual ~ResponseStream() = default;
  // Returns false at the end of the stream, whether it succeeded or failed.
  virtual bool Read(v1::SynthesizeResponse* response) = 0;
  // Ends the stream early; Read returns false soon after.
  virtual void Cancel() = 0;
  // Returns the final status. Call once, after Read returned false.
  virtual absl::Status Finish() = 0;
};

// Receives the messages of a stream that Stub::Start began, in order, from one thread at a time.
class StreamListener {
 public:
  virtual ~StreamListener() = default;
  // If it returns false, the stream is cancelled and no further message is passed.
  virtual bool OnMessage(const v1::SynthesizeResponse& response) = 0;
  // Called last, with the final status.
  virtual void OnEnd(const absl::Status& status) = 0;
};

// A live session's stream in progress. Threads: one may write while another one reads; Cancel may
// be called by any thread.
class LiveStream {
 public:
  virtual ~LiveStream() = default;
  // Blocks while the server does not read. Returns false if the stream has ended.
  virtual bool Write(const v1::SynthesizeLiveRequest& request) = 0;
  // Ends the leader's motion. No Write may follow.
  virtual bool WritesDone() = 0;
  // Returns false at the end of the stream, whether it succeeded or failed.
  virtual bool Read(v1::SynthesizeLiveResponse* response) = 0;
  // Ends the stream early; Read and Write return false soon after.
  virtual void Cancel() = 0;
  // Returns the final status. Call once, after Read returned false and the last Write returned.
  virtual absl::Status Finish() = 0;
};

// The methods of duet.v1.MotionSynthesis: proto in, proto out, one attempt. Statuses carry their
// google.rpc details as payloads (client/error_details.h).
class Stub {
 public:
  virtual ~Stub() = default;
  virtual absl::StatusOr<v1::ListModelsResponse> ListModels(
      const CallContext& context, const v1::ListModelsRequest& request) = 0;
  virtual absl::StatusOr<v1::GetModelResponse> GetModel(const CallContext& context,
                                                        const v1::GetModelRequest& request) = 0;
  virtual std::unique_ptr<ResponseStream> Synthesize(const CallContext& context,
                                                     const v1::SynthesizeRequest& request) = 0;
  // The asynchronous variant of Synthesize. Does not block.
  virtual void Start(const CallContext& context, const v1::SynthesizeRequest& request,
                     std::unique_ptr<StreamListener> listener) = 0;
  virtual std::unique_ptr<LiveStream> SynthesizeLive(const CallContext& context) = 0;
};

// Creates a stub that calls over gRPC with `token` as credentials; empty: without credentials.
std::shared_ptr<Stub> MakeGrpcStub(std::shared_ptr<grpc::Channel> channel,
                                   const std::string& token = "");

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_STUB_H_
