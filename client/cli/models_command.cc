#include "client/cli/models_command.h"

#include <memory>
#include <ostream>
#include <vector>

#include "client/cli/report.h"
#include "client/cli/server_flags.h"
#include "client/cli/server_options.h"

namespace duet::client::cli {
namespace {

struct ModelsArguments {
  ServerArguments server;
  bool json = false;
};

absl::Status RunModels(const ModelsArguments& arguments, const ProgramEnvironment& environment) {
  const absl::StatusOr<Client> client = Connect(arguments.server, environment);
  if (!client.ok()) return client.status();
  const absl::StatusOr<std::vector<ModelInfo>> models = client->ListModels();
  if (!models.ok()) return models.status();
  *environment.out << (arguments.json ? ModelsJson(*models) : DescribeModels(*models));
  return absl::OkStatus();
}

}  // namespace

Command AddModelsCommand(FlagSet* program) {
  const auto arguments = std::make_shared<ModelsArguments>();
  FlagSet* app = program->AddCommand("models", "List the models that the server serves");
  AddServerFlags(app, &arguments->server);
  app->AddSwitch("--json", &arguments->json, "Print JSON");
  return MakeServerCommand(app, arguments, RunModels);
}

}  // namespace duet::client::cli
