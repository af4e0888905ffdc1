#ifndef DUET_SERVER_ADMIN_ADMIN_SERVICE_H_
#define DUET_SERVER_ADMIN_ADMIN_SERVICE_H_

#include <memory>
#include <vector>

#include "absl/status/status.h"
#include "duet/admin/v1/admin.grpc.pb.h"
#include "server/common/clock.h"
#include "server/metrics/call_record.h"
#include "server/metrics/json_log.h"
#include "server/registry/model_manager.h"
#include "server/registry/model_registry.h"
#include "server/security/access_control.h"
#include "server/service/admission.h"
#include "server/service/call_pipeline.h"

namespace duet::server::admin {

namespace v1 = ::duet::admin::v1;

// The dependencies of the service. Everything outlives the service and its calls.
struct AdminParts {
  registry::ModelControl* control = nullptr;
  registry::ModelRegistry* registry = nullptr;
  const service::Admission* admission = nullptr;  // knows whether the server serves
  metrics::JsonLog* log = nullptr;
  std::vector<metrics::CallObserver*> observers;
  const security::AccessControl* access = nullptr;  // decides who may administer: see CallPipeline
  const common::Clock* clock = &common::Clock::Real();
};

// duet.admin.v1.Admin: changes models while calls are answered. No method blocks: the thread that
// loads ends calls that load. Each call writes a line to the log (event "admin_action") with the
// caller, the request and the result.
class AdminService final : public v1::Admin::CallbackService {
 public:
  static constexpr char kServiceName[] = "duet.admin.v1.Admin";

  explicit AdminService(AdminParts parts);

  grpc::ServerUnaryReactor* ListModels(grpc::CallbackServerContext* context,
                                       const v1::ListModelsRequest* request,
                                       v1::ListModelsResponse* response) override;
  grpc::ServerUnaryReactor* LoadModel(grpc::CallbackServerContext* context,
                                      const v1::LoadModelRequest* request,
                                      v1::LoadModelResponse* response) override;
  grpc::ServerUnaryReactor* UnloadModel(grpc::CallbackServerContext* context,
                                        const v1::UnloadModelRequest* request,
                                        v1::UnloadModelResponse* response) override;
  grpc::ServerUnaryReactor* Reload(grpc::CallbackServerContext* context,
                                   const v1::ReloadRequest* request,
                                   v1::ReloadResponse* response) override;
  grpc::ServerUnaryReactor* SetLabel(grpc::CallbackServerContext* context,
                                     const v1::SetLabelRequest* request,
                                     v1::SetLabelResponse* response) override;
  grpc::ServerUnaryReactor* DeleteLabel(grpc::CallbackServerContext* context,
                                        const v1::DeleteLabelRequest* request,
                                        v1::DeleteLabelResponse* response) override;

 private:
  // One call from its headers to its end.
  class Call;

  enum class When { kAlways, kServing };

  // The common path of every call: counts it and checks it and its request. Passes it to `answer`,
  // which ends it now or later, unless it is rejected. `when`: kServing rejects it with UNAVAILABLE
  // while the server does not serve.
  template <typename Answer>
  grpc::ServerUnaryReactor* Open(grpc::CallbackServerContext& context,
                                 const metrics::MethodInfo& method, When when,
                                 const google::protobuf::Message& request, const Answer& answer);

  const AdminParts parts_;
  const service::CallPipeline pipeline_;
};

}  // namespace duet::server::admin

#endif  // DUET_SERVER_ADMIN_ADMIN_SERVICE_H_
