#include "server/service/motion_synthesis_service.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <variant>

#include "server/service/model_message.h"
#include "server/service/priority_message.h"
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

}  // namespace

MotionSynthesisService::MotionSynthesisService(ServiceParts parts)
    : parts_(std::move(parts)),
      pipeline_(parts_.limits.max_request_bytes, parts_.observers, *parts_.clock, parts_.guard,
                security::Role::kSynthesise, parts_.trace_ratio) {}

grpc::ServerWriteReactor<grpc::ByteBuffer>* MotionSynthesisService::Synthesize(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  auto incoming = pipeline_.Open<v1::SynthesizeRequest>(
      *context, kSynthesize, *request, [this](const v1::SynthesizeRequest& opened) {
        // An unknown priority is refused by the validator, together with all else that is wrong.
        return parts_.admission->Admit(
            PriorityOf(opened).value_or(batching::Priority::kInteractive));
      });
  auto* reactor = new SynthesizeReactor(*context);
  absl::StatusOr<SynthesisCall::Parts> prepared = Prepare(*context, incoming);
  if (!prepared.ok()) {
    reactor->Finish(*incoming.scope, prepared.status());
    return reactor;
  }
  auto call = SynthesisCall::Create(*std::move(prepared), *parts_.scheduler, *reactor);
  Remember(call);
  reactor->Run(std::move(call));
  return reactor;
}

absl::StatusOr<SynthesisCall::Parts> MotionSynthesisService::Prepare(
    const grpc::CallbackServerContext& context,
    IncomingCall<v1::SynthesizeRequest>& incoming) const {
  if (!incoming.status.ok()) return incoming.status;
  AdmissionSlot slot = std::move(incoming.slot);  // free again when the request is refused
  const v1::SynthesizeRequest& request = incoming.request;
  registry::FindResult found = parts_.registry->Find(ToQuery(request.model()));
  if (const auto* not_found = std::get_if<registry::ModelNotFound>(&found)) {
    return ModelNotFoundRefusal(*not_found);
  }
  auto& served = std::get<registry::ServedModel>(found);
  const engine::ModelDescription& model = served.model->description();
  absl::StatusOr<ValidatedRequest> validated = ValidateRequest(request, model, parts_.limits);
  if (!validated.ok()) return validated.status();
  const absl::Status held = incoming.scope->HoldFrames(validated->clip.leader.frame_count());
  if (!held.ok()) return held;
  const bool servers_choice = parts_.clean_up.value_or(model.cleaned_up_by_default());
  const bool clean_up = validated->clean_up.value_or(servers_choice);
  return SynthesisCall::Parts{std::move(served.model),
                              *std::move(validated),
                              std::move(slot),
                              std::move(incoming.scope),
                              DeadlineOf(context, *parts_.clock),
                              parts_.buffered_frames,
                              clean_up};
}

template <typename Request, typename Answer>
grpc::ServerUnaryReactor* MotionSynthesisService::AnswerUnary(grpc::CallbackServerContext& context,
                                                              const metrics::MethodInfo& method,
                                                              const grpc::ByteBuffer& bytes,
                                                              grpc::ByteBuffer& response,
                                                              const Answer& answer) const {
  const auto incoming = pipeline_.Open<Request>(context, method, bytes, [this](const Request&) {
    const absl::Status serving = parts_.admission->CheckServing();
    return serving.ok() ? absl::StatusOr<AdmissionSlot>(AdmissionSlot()) : serving;
  });
  absl::Status status = incoming.status;
  if (status.ok()) {
    const auto answered = answer(incoming.request);
    status = answered.status();
    if (answered.ok()) response = SerializeMessage(*answered);
  }
  grpc::ServerUnaryReactor* reactor = context.DefaultReactor();
  CallPipeline::Close(*incoming.scope, status, context, *reactor);
  return reactor;
}

grpc::ServerUnaryReactor* MotionSynthesisService::ListModels(grpc::CallbackServerContext* context,
                                                             const grpc::ByteBuffer* request,
                                                             grpc::ByteBuffer* response) {
  return AnswerUnary<v1::ListModelsRequest>(
      *context, kListModels, *request, *response,
      [this](const v1::ListModelsRequest&) -> absl::StatusOr<v1::ListModelsResponse> {
        return List();
      });
}

v1::ListModelsResponse MotionSynthesisService::List() const {
  v1::ListModelsResponse response;
  for (const registry::ServedModel& served : parts_.registry->List()) {
    *response.add_models() = ToMessage(served);
  }
  return response;
}

grpc::ServerUnaryReactor* MotionSynthesisService::GetModel(grpc::CallbackServerContext* context,
                                                           const grpc::ByteBuffer* request,
                                                           grpc::ByteBuffer* response) {
  return AnswerUnary<v1::GetModelRequest>(
      *context, kGetModel, *request, *response,
      [this](const v1::GetModelRequest& opened) { return Get(opened); });
}

absl::StatusOr<v1::GetModelResponse> MotionSynthesisService::Get(
    const v1::GetModelRequest& request) const {
  const registry::FindResult found = parts_.registry->Find(ToQuery(request.model()));
  if (const auto* not_found = std::get_if<registry::ModelNotFound>(&found)) {
    return ModelNotFoundRefusal(*not_found);
  }
  v1::GetModelResponse response;
  *response.mutable_model() = ToMessage(std::get<registry::ServedModel>(found));
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
