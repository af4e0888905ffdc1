#ifndef DUET_SERVER_SERVICE_MOTION_SYNTHESIS_SERVICE_H_
#define DUET_SERVER_SERVICE_MOTION_SYNTHESIS_SERVICE_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "duet/v1/synthesis.pb.h"
#include "server/batching/window_scheduler.h"
#include "server/common/background_thread.h"
#include "server/common/clock.h"
#include "server/metrics/call_record.h"
#include "server/registry/model_registry.h"
#include "server/security/call_guard.h"
#include "server/service/admission.h"
#include "server/service/call_pipeline.h"
#include "server/service/call_reactor.h"
#include "server/service/live_calls.h"
#include "server/service/open_calls.h"
#include "server/service/raw_service.h"
#include "server/service/reception.h"
#include "server/service/request_limits.h"
#include "server/service/streaming_call.h"
#include "server/service/transport_quota.h"

namespace duet::server::service {

// What the service works with. Everything outlives the service and its calls.
struct ServiceParts {
  registry::ModelRegistry* registry = nullptr;
  batching::WindowScheduler* scheduler = nullptr;
  Admission* admission = nullptr;
  TransportQuota* transport = nullptr;  // null: not told of requests that have come
  std::vector<metrics::CallObserver*> observers;
  const common::Clock* clock = &common::Clock::Real();
  RequestLimits limits;
  ReceptionLimits reception;
  int buffered_frames = 0;  // see ClipStreamOptions
  // How long one message of an answer may wait for its reader, and how long a call may last. Kept
  // by whoever calls CheckTime.
  double write_timeout_seconds = std::numeric_limits<double>::infinity();
  double max_call_seconds = std::numeric_limits<double>::infinity();
  std::string client_key;              // see IdentifyCall
  security::CallGuard guard{nullptr};  // who may call; everybody unless it has a list
  // Of calls that come without a trace, the part that is sampled in one begun here. Absent: no
  // trace is begun.
  std::optional<double> trace_ratio;
  // Whether followers are cleaned up where the request does not say. Absent: as the model has it
  // (ModelDescription::cleaned_up_by_default).
  std::optional<bool> clean_up;
};

// The contract's service: no method blocks, or keeps a thread of gRPC's for long.
//
// Every call comes in by the CallPipeline and is admitted before its message is read (Reception). A
// Synthesize call goes on model -> validator -> StreamingCall, which lives until its last reply was
// taken or the caller went away.
class MotionSynthesisService final : public RawService {
 public:
  static constexpr char kServiceName[] = "duet.v1.MotionSynthesis";

  explicit MotionSynthesisService(ServiceParts parts);

  // Ends every call that is still being answered.
  void AbortAll(const absl::Status& reason) { calls_.AbortAll(reason); }

  // To be called after AbortAll: waits until every call has its status, at most this long, and then
  // gives up the readers that still have not taken what was being written.
  void FinishAborted(double seconds);

  // Ends the calls that have taken longer than they may: to arrive, to be answered, to be read. To
  // be called every few hundredths of a second.
  void CheckTime() { calls_.CheckTime(parts_.clock->Now()); }

  // Bytes of all large requests so far: memory that was used and is no more, or soon will not be.
  std::uint64_t large_request_bytes() const { return large_request_bytes_; }

 private:
  using Context = grpc::CallbackServerContext;

  Reactor* Synthesize(Context* context);
  void CountIfLarge(const grpc::ByteBuffer& bytes);
  // Handles a message that came, a large one elsewhere: gRPC has few threads, and all other calls
  // would wait.
  void Handle(CallReactor& reactor, const std::shared_ptr<Reception>& reception,
              grpc::ByteBuffer bytes);
  void HandleElsewhere(CallReactor& reactor, const std::shared_ptr<Reception>& reception,
                       grpc::ByteBuffer bytes, ShareLease held);
  // Parses the message and begins to answer; `held` are its bytes. `received` goes with the bytes.
  void Begin(CallReactor& reactor, const std::shared_ptr<Reception>& reception,
             grpc::ByteBuffer bytes, ShareLease held,
             std::shared_ptr<TransportQuota::Received> received);
  // A Synthesize call that was found valid.
  struct Prepared {
    StreamingCall::Parts call;
    std::unique_ptr<ReplySource> replies;
  };
  // Finds the model and validates the request. If it succeeds, takes place and scope from
  // `reception`.
  absl::StatusOr<Prepared> Prepare(const Context& context, Reception& reception,
                                   const v1::SynthesizeRequest& request, ShareLease held);
  v1::ListModelsResponse List() const;
  absl::StatusOr<v1::GetModelResponse> Get(const v1::GetModelRequest& request) const;
  // A method with one answer: `answer` is a StatusOr<Response> from (const Request&).
  template <typename Request, typename Answer>
  void ServeUnary(const char* path, const metrics::MethodInfo& method, Answer answer);
  // A place for a call. Readers that have stalled lose theirs to those who come.
  absl::StatusOr<ShareLease> Admit(const std::string& client);
  // Room for a request that has come. Where there is none, readers of this client that have stalled
  // make room for its next attempt.
  absl::StatusOr<ShareLease> Hold(const std::string& client, const grpc::ByteBuffer& bytes);
  std::shared_ptr<Reception> Receive(OpenedCall opened, ShareLease place, CallReactor& reactor);

  const ServiceParts parts_;
  const CallPipeline pipeline_;
  OpenCalls open_calls_;
  LiveCalls calls_;
  std::atomic<std::uint64_t> large_request_bytes_{0};
  common::BackgroundThread large_requests_{common::BackgroundThread::Share::kOrdinary};
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_MOTION_SYNTHESIS_SERVICE_H_
