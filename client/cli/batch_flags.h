#ifndef DUET_CLIENT_CLI_BATCH_FLAGS_H_
#define DUET_CLIENT_CLI_BATCH_FLAGS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/batch_arguments.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// Adds duet batch, with its flags and its commands merge and verify. `arguments` outlives the
// program.
FlagSet* AddBatchFlags(FlagSet* program, BatchArguments* arguments);

// The arguments of a command line that begins with "batch". INVALID_ARGUMENT if it is not valid.
absl::StatusOr<BatchArguments> ParseBatch(const std::vector<std::string>& words);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_FLAGS_H_
