#include "client/admin_client.h"

#include <utility>

#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "client/internal/connect.h"
#include "client/internal/grpc_status.h"
#include "client/internal/retry.h"
#include "duet/admin/v1/admin.grpc.pb.h"
#include "grpcpp/client_context.h"

namespace duet::client {
namespace {

namespace v1 = admin::v1;

ServedVersion::State FromMessage(v1::ModelState state) {
  switch (state) {
    case v1::MODEL_STATE_LOADING:
      return ServedVersion::State::kLoading;
    case v1::MODEL_STATE_SERVED:
      return ServedVersion::State::kServed;
    case v1::MODEL_STATE_FAILED:
      return ServedVersion::State::kFailed;
    case v1::MODEL_STATE_UNLOADED:
      return ServedVersion::State::kUnloaded;
    default:
      return ServedVersion::State::kUnknown;
  }
}

ServedModels FromMessage(const v1::ListModelsResponse& response) {
  ServedModels models;
  for (const v1::ModelVersion& model : response.models()) {
    models.models.push_back({model.name(),
                             model.version(),
                             FromMessage(model.state()),
                             model.error(),
                             {model.version_labels().begin(), model.version_labels().end()},
                             model.is_default(),
                             model.load_seconds(),
                             model.outdated()});
  }
  models.problems.assign(response.problems().begin(), response.problems().end());
  for (const v1::SkippedFolder& folder : response.skipped_folders()) {
    models.skipped_folders.push_back({folder.folder(), folder.reason()});
  }
  return models;
}

ReloadResult FromMessage(const v1::ReloadResponse& response) {
  return {{response.loaded().begin(), response.loaded().end()},
          {response.refused().begin(), response.refused().end()},
          {response.unloaded().begin(), response.unloaded().end()},
          response.unchanged_count(),
          {response.problems().begin(), response.problems().end()}};
}

class GrpcAdminClient final : public AdminClient {
 public:
  GrpcAdminClient(std::shared_ptr<grpc::Channel> channel, const ClientOptions& options)
      : stub_(v1::Admin::NewStub(std::move(channel))),
        deadline_(options.deadline),
        server_address_(options.server_address),
        authorization_(options.token.empty() ? "" : "Bearer " + options.token) {}

  absl::StatusOr<ServedModels> ListModels() override {
    v1::ListModelsResponse response;
    const absl::Status status =
        Call(&v1::Admin::Stub::ListModels, v1::ListModelsRequest(), &response);
    if (!status.ok()) return status;
    return FromMessage(response);
  }

  absl::Status LoadModel(const std::string& name, uint32_t version) override {
    v1::LoadModelRequest request;
    request.set_name(name);
    request.set_version(version);
    v1::LoadModelResponse response;
    return Call(&v1::Admin::Stub::LoadModel, request, &response);
  }

  absl::Status UnloadModel(const std::string& name, uint32_t version) override {
    v1::UnloadModelRequest request;
    request.set_name(name);
    request.set_version(version);
    v1::UnloadModelResponse response;
    return Call(&v1::Admin::Stub::UnloadModel, request, &response);
  }

  absl::StatusOr<ReloadResult> Reload() override {
    v1::ReloadResponse response;
    const absl::Status status = Call(&v1::Admin::Stub::Reload, v1::ReloadRequest(), &response);
    if (!status.ok()) return status;
    return FromMessage(response);
  }

  absl::Status SetLabel(const std::string& name, const std::string& label,
                        uint32_t version) override {
    v1::SetLabelRequest request;
    request.set_name(name);
    request.set_label(label);
    request.set_version(version);
    v1::SetLabelResponse response;
    return Call(&v1::Admin::Stub::SetLabel, request, &response);
  }

  absl::Status DeleteLabel(const std::string& name, const std::string& label) override {
    v1::DeleteLabelRequest request;
    request.set_name(name);
    request.set_label(label);
    v1::DeleteLabelResponse response;
    return Call(&v1::Admin::Stub::DeleteLabel, request, &response);
  }

 private:
  template <typename Request, typename Response>
  absl::Status Call(grpc::Status (v1::Admin::Stub::*method)(grpc::ClientContext*, const Request&,
                                                            Response*),
                    const Request& request, Response* response) {
    grpc::ClientContext context;
    context.set_deadline(absl::ToChronoTime(absl::Now() + deadline_));
    if (!authorization_.empty()) context.AddMetadata("authorization", authorization_);
    return internal::Explained(internal::FromGrpc((*stub_.*method)(&context, request, response)),
                               server_address_);
  }

  const std::unique_ptr<v1::Admin::Stub> stub_;
  const absl::Duration deadline_;
  const std::string server_address_;
  const std::string authorization_;  // a whole "Bearer TOKEN", or empty
};

}  // namespace

absl::StatusOr<std::unique_ptr<AdminClient>> AdminClient::Create(const ClientOptions& options) {
  absl::StatusOr<std::shared_ptr<grpc::Channel>> channel = internal::OpenChannel(options);
  if (!channel.ok()) return channel.status();
  return std::make_unique<GrpcAdminClient>(*std::move(channel), options);
}

}  // namespace duet::client
