#include "client/cli/admin_command.h"

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/admin_client.h"
#include "client/cli/report.h"
#include "client/cli/server_options.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using nlohmann::json;

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
    if (model.outdated) absl::StrAppend(&text, " (outdated: the files on disk were refused)");
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

// What has no more to tell than that it is done.
absl::Status Act(const AdminArguments& arguments, AdminClient& client) {
  switch (arguments.action) {
    case AdminArguments::Action::kLoad:
      return client.LoadModel(arguments.name, arguments.version);
    case AdminArguments::Action::kUnload:
      return client.UnloadModel(arguments.name, arguments.version);
    case AdminArguments::Action::kLabel:
      return arguments.delete_label
                 ? client.DeleteLabel(arguments.name, arguments.label)
                 : client.SetLabel(arguments.name, arguments.label, arguments.version);
    case AdminArguments::Action::kModels:
    case AdminArguments::Action::kReload:
      break;
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<ExitCode> RunAdmin(const AdminArguments& arguments,
                                  const ProgramEnvironment& environment) {
  const absl::StatusOr<ClientOptions> options = ToClientOptions(arguments.server);
  if (!options.ok()) return options.status();
  const absl::StatusOr<std::unique_ptr<AdminClient>> client = environment.connect_admin(*options);
  if (!client.ok()) return client.status();
  if (arguments.action == AdminArguments::Action::kReload) {
    const absl::StatusOr<ReloadResult> result = (*client)->Reload();
    if (!result.ok()) return result.status();
    PrintResult(*result, arguments.json, environment);
    return result->ok() ? kExitDone : kExitRetry;
  }
  const absl::Status done = Act(arguments, **client);
  if (!done.ok()) return done;
  // What came of it.
  const absl::StatusOr<ServedModels> models = (*client)->ListModels();
  if (!models.ok()) return models.status();
  PrintResult(*models, arguments.json, environment);
  return kExitDone;
}

}  // namespace duet::client::cli
