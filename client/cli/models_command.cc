#include "client/cli/models_command.h"

#include <ostream>
#include <vector>

#include "client/cli/report.h"
#include "client/cli/server_options.h"

namespace duet::client::cli {

absl::Status RunModels(const ModelsArguments& arguments, const ProgramEnvironment& environment) {
  absl::StatusOr<ClientOptions> options = ToClientOptions(arguments.server);
  if (!options.ok()) return options.status();
  SayWhenWaiting(arguments.server, *environment.err, &*options);
  const absl::StatusOr<Client> client = environment.connect(*options);
  if (!client.ok()) return client.status();
  const absl::StatusOr<std::vector<ModelInfo>> models = client->ListModels();
  if (!models.ok()) return models.status();
  *environment.out << (arguments.json ? ModelsJson(*models) : DescribeModels(*models));
  return absl::OkStatus();
}

}  // namespace duet::client::cli
