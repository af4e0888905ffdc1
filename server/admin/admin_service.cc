#include "server/admin/admin_service.h"

#include <google/protobuf/util/json_util.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "server/admin/admin_message.h"
#include "server/service/call_identity.h"
#include "server/service/call_pipeline.h"
#include "server/service/call_scope.h"
#include "server/service/refusals.h"

namespace duet::server::admin {
namespace {

constexpr metrics::MethodInfo Method(std::string_view name) {
  return {AdminService::kServiceName, name, "unary"};
}
constexpr metrics::MethodInfo kListModels = Method("ListModels");
constexpr metrics::MethodInfo kLoadModel = Method("LoadModel");
constexpr metrics::MethodInfo kUnloadModel = Method("UnloadModel");
constexpr metrics::MethodInfo kReload = Method("Reload");
constexpr metrics::MethodInfo kSetLabel = Method("SetLabel");
constexpr metrics::MethodInfo kDeleteLabel = Method("DeleteLabel");

// A request as the log shows it.
nlohmann::ordered_json Shown(const google::protobuf::Message& request) {
  std::string text;
  if (!google::protobuf::util::MessageToJsonString(request, &text).ok()) return nullptr;
  return nlohmann::ordered_json::parse(text, nullptr, /*allow_exceptions=*/false);
}

}  // namespace

// Threads: one at a time; who ends it need not be who began it.
class AdminService::Call {
 public:
  Call(grpc::CallbackServerContext& context, const metrics::MethodInfo& method,
       const google::protobuf::Message& request, const AdminParts& parts)
      : context_(context),
        reactor_(*context.DefaultReactor()),  // gRPC makes another at every call of this
        request_(Shown(request)),
        log_(*parts.log),
        scope_(method, service::IdentifyCall(context), parts.observers, *parts.clock) {}

  grpc::ServerUnaryReactor* reactor() const { return &reactor_; }

  void Finish(const absl::Status& status) {
    // A server that stops gives up what it had not begun.
    const absl::Status told = absl::IsCancelled(status) ? service::DrainingRefusal() : status;
    const metrics::CallRecord& record = scope_.record();
    log_.Info("admin", {{"method", record.method.name},
                        {"request", request_},
                        {"peer", record.peer},
                        {"request_id", record.request_id},
                        {"code", absl::StatusCodeToString(told.code())},
                        {"message", std::string(told.message())}});
    service::CallPipeline::Close(scope_, told, context_, reactor_);
  }

 private:
  grpc::CallbackServerContext& context_;
  grpc::ServerUnaryReactor& reactor_;
  const nlohmann::ordered_json request_;
  metrics::JsonLog& log_;
  service::CallScope scope_;
};

AdminService::AdminService(AdminParts parts) : parts_(std::move(parts)) {}

template <typename Request, typename Answer>
grpc::ServerUnaryReactor* AdminService::Open(grpc::CallbackServerContext& context,
                                             const metrics::MethodInfo& method,
                                             const Request& request, const Answer& answer) {
  const auto call = std::make_shared<Call>(context, method, request, parts_);
  const absl::Status valid = Validate(request);
  if (valid.ok()) {
    answer(call);
  } else {
    call->Finish(valid);
  }
  return call->reactor();
}

grpc::ServerUnaryReactor* AdminService::ListModels(grpc::CallbackServerContext* context,
                                                   const v1::ListModelsRequest* request,
                                                   v1::ListModelsResponse* response) {
  return Open(*context, kListModels, *request, [&](const auto& call) {
    *response = ToMessage(parts_.control->List(), parts_.control->skipped());
    call->Finish(absl::OkStatus());
  });
}

grpc::ServerUnaryReactor* AdminService::LoadModel(grpc::CallbackServerContext* context,
                                                  const v1::LoadModelRequest* request,
                                                  v1::LoadModelResponse*) {
  return Open(*context, kLoadModel, *request, [&](const auto& call) {
    const absl::Status serving = parts_.admission->CheckServing();
    if (!serving.ok()) return call->Finish(serving);
    parts_.control->Load(request->name(), request->version(),
                         [call](const absl::Status& status) { call->Finish(status); });
  });
}

grpc::ServerUnaryReactor* AdminService::UnloadModel(grpc::CallbackServerContext* context,
                                                    const v1::UnloadModelRequest* request,
                                                    v1::UnloadModelResponse*) {
  return Open(*context, kUnloadModel, *request, [&](const auto& call) {
    const absl::Status serving = parts_.admission->CheckServing();
    if (!serving.ok()) return call->Finish(serving);
    parts_.control->Unload(request->name(), request->version(),
                           [call](const absl::Status& status) { call->Finish(status); });
  });
}

grpc::ServerUnaryReactor* AdminService::Reload(grpc::CallbackServerContext* context,
                                               const v1::ReloadRequest* request,
                                               v1::ReloadResponse* response) {
  return Open(*context, kReload, *request, [&](const auto& call) {
    const absl::Status serving = parts_.admission->CheckServing();
    if (!serving.ok()) return call->Finish(serving);
    // The response lives until the call has ended.
    parts_.control->Reload([call, response](const absl::StatusOr<registry::ReloadReport>& report) {
      if (report.ok()) *response = ToMessage(*report);
      call->Finish(report.status());
    });
  });
}

grpc::ServerUnaryReactor* AdminService::SetLabel(grpc::CallbackServerContext* context,
                                                 const v1::SetLabelRequest* request,
                                                 v1::SetLabelResponse*) {
  return Open(*context, kSetLabel, *request, [&](const auto& call) {
    call->Finish(parts_.control->SetLabel(request->name(), request->label(), request->version()));
  });
}

grpc::ServerUnaryReactor* AdminService::DeleteLabel(grpc::CallbackServerContext* context,
                                                    const v1::DeleteLabelRequest* request,
                                                    v1::DeleteLabelResponse*) {
  return Open(*context, kDeleteLabel, *request, [&](const auto& call) {
    call->Finish(parts_.control->DeleteLabel(request->name(), request->label()));
  });
}

}  // namespace duet::server::admin
