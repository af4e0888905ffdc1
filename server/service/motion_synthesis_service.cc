#include "server/service/motion_synthesis_service.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "server/common/grpc_status.h"
#include "server/service/call_identity.h"
#include "server/service/call_scope.h"
#include "server/service/model_message.h"
#include "server/service/refusals.h"
#include "server/service/synthesize_reactor.h"
#include "server/service/validator.h"
#include "server/service/wire.h"

namespace duet::server::service {
namespace {

constexpr metrics::MethodInfo Method(std::string_view name, std::string_view type) {
  return {MotionSynthesisService::kServiceName, name, type};
}
constexpr metrics::MethodInfo kSynthesize = Method("Synthesize", "server_stream");
constexpr metrics::MethodInfo kListModels = Method("ListModels", "unary");
constexpr metrics::MethodInfo kGetModel = Method("GetModel", "unary");

// A call's deadline on the scheduler's clock.
common::TimePoint DeadlineOf(const grpc::CallbackServerContext& context,
                             const common::Clock& clock) {
  const auto left = context.deadline() - std::chrono::system_clock::now();
  // "No deadline" is so far away that adding to it overflows; beyond a day is as good as none.
  if (left > std::chrono::hours(24)) return common::TimePoint::max();
  return clock.Now() + std::chrono::duration_cast<common::TimePoint::duration>(left);
}

// Answers a unary call with a message or a status.
template <typename Response>
grpc::ServerUnaryReactor* FinishUnary(grpc::CallbackServerContext* context, CallScope& scope,
                                      const absl::StatusOr<Response>& answer,
                                      grpc::ByteBuffer* response) {
  if (answer.ok()) *response = SerializeMessage(*answer);
  scope.Finish(answer.status());
  common::AddRetryPushback(answer.status(), *context);
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  reactor->Finish(common::ToGrpcStatus(answer.status()));
  return reactor;
}

}  // namespace

grpc::ServerWriteReactor<grpc::ByteBuffer>* MotionSynthesisService::Synthesize(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  auto scope = std::make_unique<CallScope>(kSynthesize, IdentifyCall(*context), parts_.observers,
                                           *parts_.clock);
  auto* reactor = new SynthesizeReactor(*context);
  absl::StatusOr<SynthesisCall::Parts> prepared = Prepare(*context, *request);
  if (!prepared.ok()) {
    scope->Finish(prepared.status());
    reactor->Refuse(prepared.status());
    return reactor;
  }
  prepared->scope = std::move(scope);
  auto call = SynthesisCall::Create(*std::move(prepared), *parts_.scheduler, *reactor);
  Remember(call);
  reactor->Run(std::move(call));
  return reactor;
}

absl::StatusOr<SynthesisCall::Parts> MotionSynthesisService::Prepare(
    const grpc::CallbackServerContext& context, const grpc::ByteBuffer& bytes) {
  if (bytes.Length() > parts_.limits.max_request_bytes) {
    return TooLargeRefusal(bytes.Length(), parts_.limits.max_request_bytes);
  }
  v1::SynthesizeRequest request;
  const absl::Status parsed = ParseMessage(bytes, request);
  if (!parsed.ok()) return parsed;
  const batching::Priority priority = request.priority() == v1::PRIORITY_BULK
                                          ? batching::Priority::kBulk
                                          : batching::Priority::kInteractive;
  absl::StatusOr<AdmissionSlot> slot = parts_.admission->Admit(priority);
  if (!slot.ok()) return slot.status();
  absl::StatusOr<registry::ServedModel> served = parts_.registry->Find(ToQuery(request.model()));
  if (!served.ok()) return ModelNotFoundRefusal(served.status());
  absl::StatusOr<ValidatedRequest> validated =
      ValidateRequest(request, served->model->description(), parts_.limits);
  if (!validated.ok()) return validated.status();
  return SynthesisCall::Parts{
      std::move(served->model),           *std::move(validated), *std::move(slot), nullptr,
      DeadlineOf(context, *parts_.clock), parts_.buffered_frames};
}

grpc::ServerUnaryReactor* MotionSynthesisService::ListModels(grpc::CallbackServerContext* context,
                                                             const grpc::ByteBuffer* request,
                                                             grpc::ByteBuffer* response) {
  CallScope scope(kListModels, IdentifyCall(*context), parts_.observers, *parts_.clock);
  return FinishUnary(context, scope, List(*request), response);
}

absl::StatusOr<v1::ListModelsResponse> MotionSynthesisService::List(
    const grpc::ByteBuffer& bytes) const {
  v1::ListModelsRequest request;
  absl::Status status = ParseMessage(bytes, request);
  if (status.ok()) status = parts_.admission->CheckServing();
  if (!status.ok()) return status;
  v1::ListModelsResponse response;
  for (const registry::ServedModel& served : parts_.registry->List()) {
    *response.add_models() = ToMessage(served);
  }
  return response;
}

grpc::ServerUnaryReactor* MotionSynthesisService::GetModel(grpc::CallbackServerContext* context,
                                                           const grpc::ByteBuffer* request,
                                                           grpc::ByteBuffer* response) {
  CallScope scope(kGetModel, IdentifyCall(*context), parts_.observers, *parts_.clock);
  return FinishUnary(context, scope, Get(*request), response);
}

absl::StatusOr<v1::GetModelResponse> MotionSynthesisService::Get(
    const grpc::ByteBuffer& bytes) const {
  v1::GetModelRequest request;
  absl::Status status = ParseMessage(bytes, request);
  if (status.ok()) status = parts_.admission->CheckServing();
  if (!status.ok()) return status;
  const absl::StatusOr<registry::ServedModel> served =
      parts_.registry->Find(ToQuery(request.model()));
  if (!served.ok()) return ModelNotFoundRefusal(served.status());
  v1::GetModelResponse response;
  *response.mutable_model() = ToMessage(*served);
  *response.mutable_limits() = ToMessage(parts_.limits);
  return response;
}

void MotionSynthesisService::Remember(const std::shared_ptr<SynthesisCall>& call) {
  common::MutexLock lock(mutex_);
  // Admission bounds how many are alive, and so what this costs.
  calls_.erase(
      std::remove_if(calls_.begin(), calls_.end(), [](const auto& weak) { return weak.expired(); }),
      calls_.end());
  calls_.push_back(call);
}

void MotionSynthesisService::AbortAll(const absl::Status& reason) {
  std::vector<std::weak_ptr<SynthesisCall>> calls;
  {
    common::MutexLock lock(mutex_);
    calls = calls_;
  }
  for (const std::weak_ptr<SynthesisCall>& weak : calls) {
    if (const auto call = weak.lock()) call->Abort(reason);
  }
}

}  // namespace duet::server::service
