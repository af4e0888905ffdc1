#ifndef DUET_CLIENT_CLI_BATCH_SERVERS_H_
#define DUET_CLIENT_CLI_BATCH_SERVERS_H_

#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/job_folder.h"
#include "client/batch/recipe.h"
#include "client/cli/batch_arguments.h"
#include "client/cli/program_environment.h"
#include "client/client.h"

namespace duet::client::cli {

// For each server, the clients that take turns. They do not retry: the job does, for each item.
absl::StatusOr<std::vector<std::vector<Client>>> Connect(const BatchArguments& arguments,
                                                         const ProgramEnvironment& environment);

// The models as the first server that answers describes them: those that the set was begun with, or
// the recipe's for a new set.
struct ResolvedModels {
  std::vector<ModelInfo> models;
  RequestLimits limits;  // of their requests
};
absl::StatusOr<ResolvedModels> AskModels(const BatchArguments& arguments,
                                         const ProgramEnvironment& environment,
                                         const batch::Recipe& recipe,
                                         const std::vector<batch::JobIdentity::Model>& begun);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_SERVERS_H_
