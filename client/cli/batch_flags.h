#ifndef DUET_CLIENT_CLI_BATCH_FLAGS_H_
#define DUET_CLIENT_CLI_BATCH_FLAGS_H_

#include "client/cli/batch_arguments.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// Adds duet batch with its flags. `arguments` outlives the program.
FlagSet* AddBatchFlags(FlagSet* program, BatchArguments* arguments);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_FLAGS_H_
