#include "client/cli/batch_servers.h"

#include <algorithm>
#include <string>
#include <utility>

#include "absl/time/time.h"
#include "client/cli/server.h"

namespace duet::client::cli {
namespace {

// Maximum time to wait for a server before a run begins.
constexpr double kFirstAnswerSeconds = 30;

absl::StatusOr<ResolvedModels> Ask(const Client& client, const std::vector<ModelChoice>& choices) {
  ResolvedModels resolved;
  for (const ModelChoice& choice : choices) {
    absl::StatusOr<ModelDetails> details = client.GetModel(choice);
    if (!details.ok()) return details.status();
    resolved.models.push_back(std::move(details->model));
    resolved.limits = details->limits;  // the same for all models of a server
  }
  return resolved;
}

}  // namespace

absl::StatusOr<std::vector<std::vector<Client>>> Connect(const BatchArguments& arguments,
                                                         const ProgramEnvironment& environment) {
  std::vector<std::vector<Client>> servers;
  for (const std::string& address : arguments.servers) {
    ServerArguments server = arguments.connection;
    server.address = address;
    absl::StatusOr<ClientOptions> options = ToClientOptions(server);
    if (!options.ok()) return options.status();
    options->retry.max_attempts = 1;
    options->own_connection = arguments.channels > 1;
    servers.emplace_back();
    for (int i = 0; i < arguments.channels; ++i) {
      absl::StatusOr<Client> client = environment.connect(*options);
      if (!client.ok()) return client.status();
      servers.back().push_back(*std::move(client));
    }
  }
  return servers;
}

absl::StatusOr<ResolvedModels> AskModels(const BatchArguments& arguments,
                                         const ProgramEnvironment& environment,
                                         const batch::Recipe& recipe,
                                         const std::vector<batch::JobIdentity::Model>& begun) {
  std::vector<ModelChoice> choices;
  for (const batch::JobIdentity::Model& model : begun) choices.push_back(model.choice);
  if (choices.empty()) choices = recipe.models;
  absl::Status status;
  for (const std::string& address : arguments.servers) {
    ServerArguments server = arguments.connection;
    server.address = address;
    absl::StatusOr<ClientOptions> options = ToClientOptions(server);
    if (!options.ok()) return options.status();
    options->deadline =
        absl::Seconds(std::max(0.1, std::min(arguments.patience_seconds, kFirstAnswerSeconds)));
    options->wait = options->deadline;
    const absl::StatusOr<Client> client = environment.connect(*options);
    if (!client.ok()) return client.status();
    absl::StatusOr<ResolvedModels> models = Ask(*client, choices);
    if (models.ok()) return models;
    status = models.status();
    if (!absl::IsUnavailable(status) && !absl::IsDeadlineExceeded(status)) break;
  }
  return status;
}

}  // namespace duet::client::cli
