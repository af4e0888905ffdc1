#ifndef DUET_CLIENT_CLI_BATCH_FLAGS_H_
#define DUET_CLIENT_CLI_BATCH_FLAGS_H_

#include "CLI/CLI.hpp"
#include "client/cli/arguments.h"

namespace duet::client::cli {

// duet batch with its flags and its commands merge and verify. `arguments` outlives the app.
CLI::App* AddBatchCommand(CLI::App* app, BatchArguments* arguments);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_FLAGS_H_
