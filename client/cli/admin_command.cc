#include <google/protobuf/util/json_util.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "client/cli/command.h"
#include "client/cli/flags.h"
#include "client/cli/server.h"
#include "client/error_details.h"
#include "client/internal/connect.h"
#include "client/internal/grpc_status.h"
#include "client/internal/retry.h"
#include "duet/admin/v1/admin.grpc.pb.h"
#include "grpcpp/client_context.h"

namespace duet::client::cli {
namespace {

namespace v1 = ::duet::admin::v1;
using Stub = v1::Admin::Stub;

struct AdminArguments {
  enum class Action { kModels, kReload, kLoad, kUnload, kLabel };
  Action action = Action::kModels;
  ServerArguments server;
  std::string name;
  uint32_t version = 0;
  std::string label;
  bool delete_label = false;
  bool json = false;
};

using Action = AdminArguments::Action;

// "served" for MODEL_STATE_SERVED.
std::string StateName(v1::ModelState state) {
  if (state == v1::MODEL_STATE_UNSPECIFIED) return "unknown";
  return absl::AsciiStrToLower(absl::StripPrefix(v1::ModelState_Name(state), "MODEL_STATE_"));
}

template <typename List>
std::string Problems(const List& problems) {
  std::string text;
  for (const std::string& problem : problems) absl::StrAppend(&text, "problem: ", problem, "\n");
  return text;
}

std::string Describe(const v1::ListModelsResponse& models) {
  std::string text;
  for (const v1::ModelVersion& model : models.models()) {
    absl::StrAppend(&text, model.name(), "/", model.version(), "  ", StateName(model.state()));
    if (model.outdated()) absl::StrAppend(&text, " (outdated: the files on disk were rejected)");
    if (model.is_default()) absl::StrAppend(&text, ", default");
    if (!model.version_labels().empty()) {
      absl::StrAppend(&text, ", labels: ", absl::StrJoin(model.version_labels(), ", "));
    }
    absl::StrAppend(&text, "\n");
    if (!model.error().empty()) absl::StrAppend(&text, "    ", model.error(), "\n");
  }
  for (const v1::SkippedFolder& folder : models.skipped_folders()) {
    absl::StrAppend(&text, folder.folder(), "  skipped: ", folder.reason(), "\n");
  }
  return text + Problems(models.problems());
}

std::string Describe(const v1::ReloadResponse& result) {
  std::string text;
  const auto add = [&text](absl::string_view what, const auto& versions) {
    if (!versions.empty()) absl::StrAppend(&text, what, ": ", absl::StrJoin(versions, ", "), "\n");
  };
  add("loaded", result.loaded());
  add("refused", result.refused());
  add("unloaded", result.unloaded());
  absl::StrAppend(&text, "unchanged: ", result.unchanged_count(), "\n");
  return text + Problems(result.problems());
}

std::string ToJson(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  // Cannot fail for a message without Any.
  (void)google::protobuf::util::MessageToJsonString(message, &json, options);
  return json;
}

template <typename Result>
void PrintResult(const Result& result, bool as_json, const ProgramEnvironment& environment) {
  *environment.out << (as_json ? ToJson(result) : Describe(result));
}

// Calls the admin service, without retries.
class Caller {
 public:
  explicit Caller(ClientOptions options) : options_(std::move(options)) {}

  absl::Status Open() {
    absl::StatusOr<std::shared_ptr<grpc::Channel>> channel = internal::OpenChannel(options_);
    if (channel.ok()) stub_ = v1::Admin::NewStub(*std::move(channel));
    return channel.status();
  }

  template <typename Request, typename Response>
  absl::StatusOr<Response> Call(grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&,
                                                             Response*),
                                const Request& request) {
    const auto context = internal::NewContext(absl::Now() + options_.deadline, options_.token);
    Response response;
    const absl::Status status =
        internal::FromGrpc(((*stub_).*method)(context.get(), request, &response));
    if (!status.ok()) return internal::Explained(status, options_.server_address);
    return response;
  }

 private:
  const ClientOptions options_;
  std::unique_ptr<Stub> stub_;
};

// Runs an action without a result.
absl::Status Act(const AdminArguments& arguments, Caller& caller) {
  const auto about_model = [&arguments](auto request) {
    request.set_name(arguments.name);
    return request;
  };
  const auto about_version = [&](auto request) {
    request.set_version(arguments.version);
    return about_model(std::move(request));
  };
  if (arguments.action == Action::kLoad) {
    return caller.Call(&Stub::LoadModel, about_version(v1::LoadModelRequest())).status();
  }
  if (arguments.action == Action::kUnload) {
    return caller.Call(&Stub::UnloadModel, about_version(v1::UnloadModelRequest())).status();
  }
  if (arguments.action != Action::kLabel) return absl::OkStatus();
  if (arguments.delete_label) {
    auto request = about_model(v1::DeleteLabelRequest());
    request.set_label(arguments.label);
    return caller.Call(&Stub::DeleteLabel, request).status();
  }
  auto request = about_version(v1::SetLabelRequest());
  request.set_label(arguments.label);
  return caller.Call(&Stub::SetLabel, request).status();
}

absl::StatusOr<ExitCode> CallServer(const AdminArguments& arguments,
                                    const ProgramEnvironment& environment) {
  const absl::StatusOr<ClientOptions> options = ToClientOptions(arguments.server);
  if (!options.ok()) return options.status();
  Caller caller(*options);
  absl::Status status = caller.Open();
  if (!status.ok()) return status;
  if (arguments.action == Action::kReload) {
    const auto result = caller.Call(&Stub::Reload, v1::ReloadRequest());
    if (!result.ok()) return result.status();
    PrintResult(*result, arguments.json, environment);
    // Whether the server serves everything that its configuration specifies.
    return result->refused().empty() && result->problems().empty() ? kExitDone : kExitRetry;
  }
  status = Act(arguments, caller);
  if (!status.ok()) return status;
  const auto models = caller.Call(&Stub::ListModels, v1::ListModelsRequest());
  if (!models.ok()) return models.status();
  PrintResult(*models, arguments.json, environment);
  return kExitDone;
}

absl::StatusOr<ExitCode> RunAdmin(const AdminArguments& arguments,
                                  const ProgramEnvironment& environment) {
  const absl::StatusOr<ExitCode> code = CallServer(arguments, environment);
  // The hint about --server does not apply: the admin service has its own address and its own flag.
  if (!absl::IsUnavailable(code.status()) || !ErrorReason(code.status()).empty()) return code;
  *environment.err << "duet: " << code.status().message()
                   << " (UNAVAILABLE)\nThe admin service is off unless the server's configuration "
                      "sets admin_listen. Name its address with --admin-server HOST:PORT.\n";
  return kExitRetry;
}

constexpr char kFooter[] = R"(
The admin service of a server is off unless its configuration sets admin_listen.

Examples:
  duet admin models
  duet admin load sbu 3
  duet admin label sbu canary 3
  duet admin reload
)";

// The flags of duet admin may also follow the action.
CLI::App* AddAction(CLI::App* app, const char* name, const char* help, Action action,
                    AdminArguments* arguments) {
  CLI::App* command = app->add_subcommand(name, help);
  command->fallthrough();
  command->callback([arguments, action] { arguments->action = action; });
  return command;
}

void AddModel(CLI::App* command, AdminArguments* arguments) {
  command->add_option("name", arguments->name, "Name of the model")->required()->type_name("NAME");
}

CLI::Option* AddVersion(CLI::App* command, AdminArguments* arguments) {
  return command->add_option("version", arguments->version, "Version of the model")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{std::numeric_limits<uint32_t>::max()}))
      ->type_name("VERSION");
}

void AddFlags(CLI::App* command, AdminArguments* arguments) {
  command->require_subcommand(1);
  command->footer(kFooter);
  arguments->server.address = "localhost:50052";
  command->add_option("--admin-server", arguments->server.address, "Address of the admin service")
      ->capture_default_str()
      ->type_name("HOST:PORT")
      ->group(kServerGroup);
  AddConnectionFlags(command, &arguments->server);
  command->add_flag("--json", arguments->json, "Print JSON");
  AddAction(command, "models", "List every version and its state", Action::kModels, arguments);
  AddAction(command, "reload", "Reload the configuration and the model repository", Action::kReload,
            arguments);
  CLI::App* load = AddAction(command, "load", "Load a version; reload it if it is already served",
                             Action::kLoad, arguments);
  AddModel(load, arguments);
  AddVersion(load, arguments)->required();
  CLI::App* unload =
      AddAction(command, "unload", "Stop serving a version", Action::kUnload, arguments);
  AddModel(unload, arguments);
  AddVersion(unload, arguments)->required();
  CLI::App* label =
      AddAction(command, "label", "Point a version label at a version", Action::kLabel, arguments);
  AddModel(label, arguments);
  label->add_option("label", arguments->label, "Version label")->required()->type_name("LABEL");
  CLI::Option* version = AddVersion(label, arguments);
  CLI::Option* remove = label->add_flag("--delete", arguments->delete_label, "Delete the label");
  remove->excludes(version);
  label->callback([arguments, version, remove] {
    arguments->action = Action::kLabel;
    if (version->count() == 0 && remove->count() == 0) RejectMissing("version or --delete");
  });
}

}  // namespace

Command AddAdminCommand(CLI::App* program) {
  const auto arguments = std::make_shared<AdminArguments>();
  CLI::App* app = program->add_subcommand("admin", "Change which models a running server serves");
  AddFlags(app, arguments.get());
  return MakeCommand(app, arguments, RunAdmin);
}

}  // namespace duet::client::cli
