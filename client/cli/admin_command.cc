#include <cstdint>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/admin_client.h"
#include "client/cli/command.h"
#include "client/cli/flags.h"
#include "client/cli/report.h"
#include "client/cli/server.h"
#include "client/error_details.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

struct AdminArguments {
  enum class Action { kModels, kReload, kLoad, kUnload, kLabel };
  Action action = Action::kModels;
  ServerArguments server = AdminServer();
  std::string name;
  uint32_t version = 0;
  std::string label;
  bool delete_label = false;
  bool json = false;

 private:
  static ServerArguments AdminServer() {
    ServerArguments server;
    server.address = "localhost:50052";
    return server;
  }
};

using nlohmann::json;
using Action = AdminArguments::Action;

const char* StateName(ServedVersion::State state) {
  switch (state) {
    case ServedVersion::State::kLoading:
      return "loading";
    case ServedVersion::State::kServed:
      return "served";
    case ServedVersion::State::kFailed:
      return "failed";
    case ServedVersion::State::kUnloaded:
      return "unloaded";
    case ServedVersion::State::kUnknown:
      break;
  }
  return "unknown";
}

std::string Describe(const ServedModels& models) {
  std::string text;
  for (const ServedVersion& model : models.models) {
    absl::StrAppend(&text, model.name, "/", model.version, "  ", StateName(model.state));
    if (model.outdated) absl::StrAppend(&text, " (outdated: the files on disk were rejected)");
    if (model.is_default) absl::StrAppend(&text, ", default");
    if (!model.version_labels.empty()) {
      absl::StrAppend(&text, ", labels: ", absl::StrJoin(model.version_labels, ", "));
    }
    absl::StrAppend(&text, "\n");
    if (!model.error.empty()) absl::StrAppend(&text, "    ", model.error, "\n");
  }
  for (const SkippedFolder& folder : models.skipped_folders) {
    absl::StrAppend(&text, folder.folder, "  skipped: ", folder.reason, "\n");
  }
  for (const std::string& problem : models.problems) {
    absl::StrAppend(&text, "problem: ", problem, "\n");
  }
  return text;
}

json ToJson(const ServedModels& models) {
  json list = json::array();
  for (const ServedVersion& model : models.models) {
    list.push_back({{"name", model.name},
                    {"version", model.version},
                    {"state", StateName(model.state)},
                    {"error", model.error},
                    {"version_labels", model.version_labels},
                    {"is_default", model.is_default},
                    {"load_seconds", model.load_seconds},
                    {"outdated", model.outdated}});
  }
  json skipped = json::array();
  for (const SkippedFolder& folder : models.skipped_folders) {
    skipped.push_back({{"folder", folder.folder}, {"reason", folder.reason}});
  }
  return {{"models", list}, {"skipped_folders", skipped}, {"problems", models.problems}};
}

std::string Describe(const ReloadResult& result) {
  std::string text;
  const auto add = [&text](absl::string_view what, const std::vector<std::string>& versions) {
    if (!versions.empty()) absl::StrAppend(&text, what, ": ", absl::StrJoin(versions, ", "), "\n");
  };
  add("loaded", result.loaded);
  add("refused", result.refused);
  add("unloaded", result.unloaded);
  absl::StrAppend(&text, "unchanged: ", result.unchanged, "\n");
  for (const std::string& problem : result.problems) {
    absl::StrAppend(&text, "problem: ", problem, "\n");
  }
  return text;
}

json ToJson(const ReloadResult& result) {
  return {{"loaded", result.loaded},
          {"refused", result.refused},
          {"unloaded", result.unloaded},
          {"unchanged", result.unchanged},
          {"problems", result.problems}};
}

template <typename Result>
void PrintResult(const Result& result, bool as_json, const ProgramEnvironment& environment) {
  *environment.out << (as_json ? Print(ToJson(result)) : Describe(result));
}

// Runs an action without a result.
absl::Status Act(const AdminArguments& arguments, AdminClient& client) {
  switch (arguments.action) {
    case Action::kLoad:
      return client.LoadModel(arguments.name, arguments.version);
    case Action::kUnload:
      return client.UnloadModel(arguments.name, arguments.version);
    case Action::kLabel:
      return arguments.delete_label
                 ? client.DeleteLabel(arguments.name, arguments.label)
                 : client.SetLabel(arguments.name, arguments.label, arguments.version);
    case Action::kModels:
    case Action::kReload:
      break;
  }
  return absl::OkStatus();
}

absl::StatusOr<ExitCode> CallServer(const AdminArguments& arguments,
                                    const ProgramEnvironment& environment) {
  const absl::StatusOr<ClientOptions> options = ToClientOptions(arguments.server);
  if (!options.ok()) return options.status();
  const absl::StatusOr<std::unique_ptr<AdminClient>> client = environment.connect_admin(*options);
  if (!client.ok()) return client.status();
  if (arguments.action == Action::kReload) {
    const absl::StatusOr<ReloadResult> result = (*client)->Reload();
    if (!result.ok()) return result.status();
    PrintResult(*result, arguments.json, environment);
    return result->ok() ? kExitDone : kExitRetry;
  }
  const absl::Status done = Act(arguments, **client);
  if (!done.ok()) return done;
  const absl::StatusOr<ServedModels> models = (*client)->ListModels();
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
  return MakeServerCommand(app, arguments, RunAdmin);
}

}  // namespace duet::client::cli
