#include "server/admin/admin_service.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "duet/admin/v1/admin.pb.h"
#include "model/base/text.h"
#include "server/common/error_details.h"
#include "server/registry/model_repository.h"
#include "server/service/refusals.h"

namespace duet::server::admin {
namespace {

namespace v1 = ::duet::admin::v1;

constexpr std::size_t kLongestLabel = 63;

bool IsLabel(const std::string& text) {
  return !text.empty() && text.size() <= kLongestLabel &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return absl::ascii_isalnum(c) || c == '-' || c == '_' || c == '.';
         });
}

// Checks that a request has a name, a version and a label, as far as its type has such fields.
absl::Status Check(const google::protobuf::Message& request) {
  const google::protobuf::Descriptor& type = *request.GetDescriptor();
  const google::protobuf::Reflection& reflection = *request.GetReflection();
  service::Violations violations;
  if (const auto* name = type.FindFieldByName("name")) {
    if (reflection.GetString(request, name).empty()) {
      violations.Malformed("name", "a model's name", "none");
    }
  }
  if (const auto* field = type.FindFieldByName("label")) {
    const std::string label = reflection.GetString(request, field);
    if (!IsLabel(label)) {
      violations.Malformed(
          "label", absl::StrCat("1 to ", kLongestLabel, " letters, digits, '-', '_' and '.'"),
          base::Quoted(label));
    }
  }
  if (const auto* version = type.FindFieldByName("version")) {
    if (reflection.GetUInt32(request, version) == 0) {
      violations.Malformed("version", "a version of 1 or more", "none");
    }
  }
  return violations.ToStatus();
}

v1::ModelState ToMessage(registry::ModelState state) {
  switch (state) {
    case registry::ModelState::kLoading:
      return v1::MODEL_STATE_LOADING;
    case registry::ModelState::kServed:
      return v1::MODEL_STATE_SERVED;
    case registry::ModelState::kFailed:
      return v1::MODEL_STATE_FAILED;
    case registry::ModelState::kUnloaded:
      return v1::MODEL_STATE_UNLOADED;
  }
  return v1::MODEL_STATE_UNSPECIFIED;
}

v1::ListModelsResponse ToMessage(const std::vector<registry::ModelStatus>& models,
                                 const std::vector<registry::SkippedFolder>& skipped,
                                 const std::vector<std::string>& problems) {
  v1::ListModelsResponse response;
  for (const registry::ModelStatus& model : models) {
    v1::ModelVersion* message = response.add_models();
    message->set_name(model.name);
    message->set_version(model.version);
    message->set_state(ToMessage(model.state));
    message->set_error(model.error);
    for (const std::string& label : model.version_labels) message->add_version_labels(label);
    message->set_is_default(model.is_default);
    message->set_load_seconds(model.load_seconds);
    message->set_outdated(model.outdated);
  }
  for (const registry::SkippedFolder& folder : skipped) {
    v1::SkippedFolder* message = response.add_skipped_folders();
    message->set_folder(folder.folder);
    message->set_reason(folder.reason);
  }
  for (const std::string& problem : problems) response.add_problems(problem);
  return response;
}

v1::ReloadResponse ToMessage(const registry::ReloadReport& report) {
  v1::ReloadResponse response;
  for (const std::string& version : report.loaded) response.add_loaded(version);
  for (const std::string& version : report.refused) response.add_refused(version);
  for (const std::string& version : report.unloaded) response.add_unloaded(version);
  response.set_unchanged_count(static_cast<uint32_t>(report.unchanged));
  for (const std::string& problem : report.problems) response.add_problems(problem);
  for (const std::string& label : report.refused_labels) response.add_problems(label);
  return response;
}

constexpr metrics::MethodInfo Method(std::string_view name) {
  return {AdminService::kServiceName, name, "unary"};
}
constexpr metrics::MethodInfo kListModels = Method("ListModels");
constexpr metrics::MethodInfo kLoadModel = Method("LoadModel");
constexpr metrics::MethodInfo kUnloadModel = Method("UnloadModel");
constexpr metrics::MethodInfo kReload = Method("Reload");
constexpr metrics::MethodInfo kSetLabel = Method("SetLabel");
constexpr metrics::MethodInfo kDeleteLabel = Method("DeleteLabel");

// Returns the fields of a request, for the audit log.
std::vector<std::pair<std::string, std::string>> ArgumentsOf(
    const google::protobuf::Message& request) {
  using google::protobuf::FieldDescriptor;
  std::vector<const FieldDescriptor*> fields;
  request.GetReflection()->ListFields(request, &fields);
  std::vector<std::pair<std::string, std::string>> arguments;
  for (const FieldDescriptor* field : fields) {
    const bool is_text = field->cpp_type() == FieldDescriptor::CPPTYPE_STRING;
    arguments.emplace_back(
        field->name(), is_text ? request.GetReflection()->GetString(request, field)
                               : absl::StrCat(request.GetReflection()->GetUInt32(request, field)));
  }
  return arguments;
}

}  // namespace

// Threads: one at a time; another thread may end the call than began it.
class AdminService::Call {
 public:
  Call(grpc::CallbackServerContext& context, const metrics::MethodInfo& method,
       const google::protobuf::Message& request, const AdminService& service)
      : context_(context),
        reactor_(*context.DefaultReactor()),  // call it once: each call makes another reactor
        arguments_(ArgumentsOf(request)),
        log_(*service.parts_.log),
        opened_(service.pipeline_.Open(context, method)) {}

  grpc::ServerUnaryReactor* reactor() const { return &reactor_; }
  // OK, or the reason why the call is rejected.
  const absl::Status& status() const { return opened_.status; }

  void Finish(const absl::Status& status) {
    // A server that stops cancels what it has not begun.
    const absl::Status reported = absl::IsCancelled(status) ? service::DrainingRefusal() : status;
    log_.Audit(opened_.scope->record(), reported, arguments_);
    service::CallPipeline::Report(*opened_.scope, reported, context_);
    reactor_.Finish(common::ToGrpcStatus(reported));
  }

 private:
  grpc::CallbackServerContext& context_;
  grpc::ServerUnaryReactor& reactor_;
  const std::vector<std::pair<std::string, std::string>> arguments_;
  metrics::JsonLog& log_;
  const service::OpenedCall opened_;
};

AdminService::AdminService(AdminParts parts)
    : parts_(std::move(parts)),
      pipeline_(/*client_key=*/"", parts_.observers, *parts_.clock, parts_.access,
                security::Role::kAdmin) {}

template <typename Answer>
grpc::ServerUnaryReactor* AdminService::Open(grpc::CallbackServerContext& context,
                                             const metrics::MethodInfo& method, When when,
                                             const google::protobuf::Message& request,
                                             const Answer& answer) {
  const auto call = std::make_shared<Call>(context, method, request, *this);
  absl::Status admitted = call->status();
  if (admitted.ok()) admitted = Check(request);
  if (admitted.ok() && when == When::kServing) admitted = parts_.admission->CheckServing();
  if (admitted.ok()) {
    answer(call);
  } else {
    call->Finish(admitted);
  }
  return call->reactor();
}

grpc::ServerUnaryReactor* AdminService::ListModels(grpc::CallbackServerContext* context,
                                                   const v1::ListModelsRequest* request,
                                                   v1::ListModelsResponse* response) {
  return Open(*context, kListModels, When::kAlways, *request, [&](const auto& call) {
    *response =
        ToMessage(parts_.control->List(), parts_.control->skipped(), parts_.control->problems());
    call->Finish(absl::OkStatus());
  });
}

grpc::ServerUnaryReactor* AdminService::LoadModel(grpc::CallbackServerContext* context,
                                                  const v1::LoadModelRequest* request,
                                                  v1::LoadModelResponse*) {
  return Open(*context, kLoadModel, When::kServing, *request, [&](const auto& call) {
    parts_.control->Load(request->name(), request->version(),
                         [call](const absl::Status& status) { call->Finish(status); });
  });
}

grpc::ServerUnaryReactor* AdminService::UnloadModel(grpc::CallbackServerContext* context,
                                                    const v1::UnloadModelRequest* request,
                                                    v1::UnloadModelResponse*) {
  return Open(*context, kUnloadModel, When::kServing, *request, [&](const auto& call) {
    parts_.control->Unload(request->name(), request->version(),
                           [call](const absl::Status& status) { call->Finish(status); });
  });
}

grpc::ServerUnaryReactor* AdminService::Reload(grpc::CallbackServerContext* context,
                                               const v1::ReloadRequest* request,
                                               v1::ReloadResponse* response) {
  return Open(*context, kReload, When::kServing, *request, [&](const auto& call) {
    // The response lives until the call ends.
    parts_.control->Reload([call, response](const absl::StatusOr<registry::ReloadReport>& report) {
      if (report.ok()) *response = ToMessage(*report);
      call->Finish(report.status());
    });
  });
}

grpc::ServerUnaryReactor* AdminService::SetLabel(grpc::CallbackServerContext* context,
                                                 const v1::SetLabelRequest* request,
                                                 v1::SetLabelResponse*) {
  return Open(*context, kSetLabel, When::kAlways, *request, [&](const auto& call) {
    call->Finish(parts_.registry->SetLabel(request->name(), request->label(), request->version()));
  });
}

grpc::ServerUnaryReactor* AdminService::DeleteLabel(grpc::CallbackServerContext* context,
                                                    const v1::DeleteLabelRequest* request,
                                                    v1::DeleteLabelResponse*) {
  return Open(*context, kDeleteLabel, When::kAlways, *request, [&](const auto& call) {
    call->Finish(parts_.registry->DeleteLabel(request->name(), request->label()));
  });
}

}  // namespace duet::server::admin
