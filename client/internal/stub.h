#ifndef DUET_CLIENT_INTERNAL_STUB_H_
#define DUET_CLIENT_INTERNAL_STUB_H_

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "duet/v1/synthesis.pb.h"

namespace duet::client::internal {

// What one attempt at a call carries beside its request.
struct CallContext {
  absl::Time deadline;
  std::string request_id;  // may be empty
};

// A response stream in progress. Not safe to call concurrently.
class ResponseStream {
 public:
  virtual ~ResponseStream() = default;
  // False at the stream's end, however it ended.
  virtual bool Read(v1::SynthesizeResponse* response) = 0;
  // Ends the stream early; Read returns false soon after.
  virtual void Cancel() = 0;
  // How the stream ended. Called once, after Read returned false.
  virtual absl::Status Finish() = 0;
};

// Hears of a stream that Stub::Start began: in its order, on one thread at a time.
class StreamListener {
 public:
  virtual ~StreamListener() = default;
  // False: the rest is of no use, the stream is cancelled and no other message comes.
  virtual bool OnMessage(const v1::SynthesizeResponse& response) = 0;
  // How the stream ended. Last.
  virtual void OnEnd(const absl::Status& status) = 0;
};

// One attempt at each call of duet.v1.MotionSynthesis: proto in, proto out, no retry. Statuses
// carry their google.rpc details as payloads (client/error_details.h).
class Stub {
 public:
  virtual ~Stub() = default;
  virtual absl::StatusOr<v1::ListModelsResponse> ListModels(
      const CallContext& context, const v1::ListModelsRequest& request) = 0;
  virtual absl::StatusOr<v1::GetModelResponse> GetModel(const CallContext& context,
                                                        const v1::GetModelRequest& request) = 0;
  virtual std::unique_ptr<ResponseStream> Synthesize(const CallContext& context,
                                                     const v1::SynthesizeRequest& request) = 0;
  // The same without waiting.
  virtual void Start(const CallContext& context, const v1::SynthesizeRequest& request,
                     std::unique_ptr<StreamListener> listener) = 0;
};

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_STUB_H_
