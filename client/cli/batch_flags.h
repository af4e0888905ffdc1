#ifndef DUET_CLIENT_CLI_BATCH_FLAGS_H_
#define DUET_CLIENT_CLI_BATCH_FLAGS_H_

#include <CLI/CLI.hpp>

#include "client/cli/batch_arguments.h"

namespace duet::client::cli {

// Adds duet batch with its flags. `arguments` outlives the program.
CLI::App* AddBatchFlags(CLI::App* program, BatchArguments* arguments);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_FLAGS_H_
