#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/command.h"
#include "client/cli/server.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using nlohmann::json;

struct ModelsArguments {
  ServerArguments server;
  bool json = false;
};

std::string DescribeModel(const ModelInfo& model) {
  std::string text = absl::StrCat(model.name, "@", model.version);
  if (!model.version_labels.empty()) {
    absl::StrAppend(&text, " (", absl::StrJoin(model.version_labels, ", "), ")");
  }
  if (model.is_default) absl::StrAppend(&text, ", default");
  absl::StrAppend(&text, "\n  classes   ", absl::StrJoin(model.interaction_classes, ", "));
  absl::StrAppend(&text, "\n  joints    ", model.joint_names.size(), ", root ", model.root_joint);
  absl::StrAppendFormat(&text, "\n  works at  %g Hz in windows of %d frames", model.frame_rate_hz,
                        model.window_frames);
  absl::StrAppend(&text, "\n  follower  ",
                  model.accepts_follower_start ? "may be given a start" : "chooses its own start");
  absl::StrAppend(&text, "\n  answers   ",
                  model.samples ? "vary with --seed and --variety" : "one, whatever the seed");
  if (!model.description.empty()) absl::StrAppend(&text, "\n  about     ", model.description);
  if (!model.terms.empty()) absl::StrAppend(&text, "\n  terms     ", model.terms);
  if (model.free_for_all_uses) {
    absl::StrAppend(&text,
                    "\n  free      anybody may use the model and its output for any purpose");
  }
  return text + "\n";
}

json ModelJson(const ModelInfo& model) {
  json bones = json::array();
  for (const motion::Bone& bone : model.bones) bones.push_back({bone.parent, bone.child});
  return {{"name", model.name},
          {"version", model.version},
          {"version_labels", model.version_labels},
          {"is_default", model.is_default},
          {"interaction_classes", model.interaction_classes},
          {"joint_names", model.joint_names},
          {"bones", bones},
          {"root_joint", model.root_joint},
          {"frame_rate_hz", model.frame_rate_hz},
          {"window_frames", model.window_frames},
          {"accepts_follower_start", model.accepts_follower_start},
          {"samples", model.samples},
          {"description", model.description},
          {"terms", model.terms},
          {"free_for_all_uses", model.free_for_all_uses},
          {"weights_sha256", model.weights_sha256}};
}

std::string DescribeModels(const std::vector<ModelInfo>& models) {
  if (models.empty()) return "The server serves no model.\n";
  return absl::StrJoin(models, "", [](std::string* out, const ModelInfo& model) {
    out->append(DescribeModel(model));
  });
}

absl::Status RunModels(const ModelsArguments& arguments, const ProgramEnvironment& environment) {
  const absl::StatusOr<Client> client = Connect(arguments.server, environment);
  if (!client.ok()) return client.status();
  const absl::StatusOr<std::vector<ModelInfo>> models = client->ListModels();
  if (!models.ok()) return models.status();
  json list = json::array();
  for (const ModelInfo& model : *models) list.push_back(ModelJson(model));
  *environment.out << (arguments.json ? Print({{"models", list}}) : DescribeModels(*models));
  return absl::OkStatus();
}

}  // namespace

Command AddModelsCommand(CLI::App* program) {
  const auto arguments = std::make_shared<ModelsArguments>();
  CLI::App* app = program->add_subcommand("models", "List the models that the server serves");
  AddServerFlags(app, &arguments->server);
  app->add_flag("--json", arguments->json, "Print JSON");
  return MakeCommand(app, arguments, RunModels);
}

}  // namespace duet::client::cli
