#ifndef DUET_SERVER_SERVICE_MOTION_SYNTHESIS_SERVICE_H_
#define DUET_SERVER_SERVICE_MOTION_SYNTHESIS_SERVICE_H_

#include <memory>
#include <optional>
#include <vector>

#include "duet/v1/synthesis.grpc.pb.h"
#include "server/batching/window_scheduler.h"
#include "server/common/clock.h"
#include "server/common/mutex.h"
#include "server/metrics/call_record.h"
#include "server/registry/model_registry.h"
#include "server/security/call_guard.h"
#include "server/service/admission.h"
#include "server/service/call_pipeline.h"
#include "server/service/request_limits.h"
#include "server/service/synthesis_call.h"

namespace duet::server::service {

// What the service works with. Everything outlives the service and its calls.
struct ServiceParts {
  registry::ModelRegistry* registry = nullptr;
  batching::WindowScheduler* scheduler = nullptr;
  Admission* admission = nullptr;
  std::vector<metrics::CallObserver*> observers;
  const common::Clock* clock = &common::Clock::Real();
  RequestLimits limits;
  int buffered_frames = 0;             // see ClipStreamOptions
  security::CallGuard guard{nullptr};  // who may call; everybody unless it has a list
  // Of calls that come without a trace, the part that is sampled in one begun here. Absent: no
  // trace is begun.
  std::optional<double> trace_ratio;
  // Whether followers are cleaned up where the request does not say. Absent: as the model has it
  // (ModelDescription::cleaned_up_by_default).
  std::optional<bool> clean_up;
};

// The generated service with every method on the callback API, and bytes for messages (wire.h).
using RawMotionSynthesis = v1::MotionSynthesis::WithRawCallbackMethod_Synthesize<
    v1::MotionSynthesis::WithRawCallbackMethod_ListModels<
        v1::MotionSynthesis::WithRawCallbackMethod_GetModel<v1::MotionSynthesis::Service>>>;

// The contract's service: no method blocks.
//
// Every call comes in by the CallPipeline. A Synthesize call goes on model -> validator ->
// SynthesisCall, which lives until its last reply was taken or the caller went away.
class MotionSynthesisService final : public RawMotionSynthesis {
 public:
  static constexpr char kServiceName[] = "duet.v1.MotionSynthesis";

  explicit MotionSynthesisService(ServiceParts parts);

  grpc::ServerWriteReactor<grpc::ByteBuffer>* Synthesize(grpc::CallbackServerContext* context,
                                                         const grpc::ByteBuffer* request) override;
  grpc::ServerUnaryReactor* ListModels(grpc::CallbackServerContext* context,
                                       const grpc::ByteBuffer* request,
                                       grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* GetModel(grpc::CallbackServerContext* context,
                                     const grpc::ByteBuffer* request,
                                     grpc::ByteBuffer* response) override;

  // Ends every call that is still being answered.
  void AbortAll(const absl::Status& reason);

 private:
  // Finds the model and checks the request. Takes the call's slot, and its scope where the call
  // goes on; that of a refused call stays.
  absl::StatusOr<SynthesisCall::Parts> Prepare(const grpc::CallbackServerContext& context,
                                               IncomingCall<v1::SynthesizeRequest>& incoming) const;
  v1::ListModelsResponse List() const;
  absl::StatusOr<v1::GetModelResponse> Get(const v1::GetModelRequest& request) const;
  // A unary call, from the bytes of its request to those of its response. `answer`: a response or a
  // status from (const Request&).
  template <typename Request, typename Answer>
  grpc::ServerUnaryReactor* AnswerUnary(grpc::CallbackServerContext& context,
                                        const metrics::MethodInfo& method,
                                        const grpc::ByteBuffer& bytes, grpc::ByteBuffer& response,
                                        const Answer& answer) const;
  void Remember(const std::shared_ptr<SynthesisCall>& call);

  const ServiceParts parts_;
  const CallPipeline pipeline_;
  common::Mutex mutex_;
  std::vector<std::weak_ptr<SynthesisCall>> calls_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_MOTION_SYNTHESIS_SERVICE_H_
