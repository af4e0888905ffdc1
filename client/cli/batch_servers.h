#ifndef DUET_CLIENT_CLI_BATCH_SERVERS_H_
#define DUET_CLIENT_CLI_BATCH_SERVERS_H_

#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/recipe.h"
#include "client/batch/setup.h"
#include "client/cli/arguments.h"
#include "client/cli/program.h"
#include "client/client.h"

namespace duet::client::cli {

// For each server the clients that take turns. Retries are the job's own, item by item.
absl::StatusOr<std::vector<std::vector<Client>>> Connect(const BatchArguments& arguments,
                                                         const ProgramEnvironment& environment);

// The models, from the first server that answers: those that a set was begun with, or else the
// recipe's.
absl::StatusOr<batch::ResolvedModels> AskModels(const BatchArguments& arguments,
                                                const ProgramEnvironment& environment,
                                                const batch::Recipe& recipe,
                                                const std::vector<ModelChoice>& begun);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_SERVERS_H_
