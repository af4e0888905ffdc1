#ifndef DUET_CLIENT_CLI_BATCH_ARGUMENTS_H_
#define DUET_CLIENT_CLI_BATCH_ARGUMENTS_H_

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "client/batch/failures.h"
#include "client/batch/flow/call_gate.h"
#include "client/batch/recipe.h"
#include "client/batch/shard.h"
#include "client/batch/survey.h"
#include "client/cli/server.h"
#include "client/options.h"

namespace duet::client::cli {

// The flags of duet batch.
struct BatchArguments {
  std::vector<std::string> leaders;     // files, folders
  std::string manifest;                 // a file, "-" or empty
  std::filesystem::path manifest_copy;  // the manifest "-" once it was read
  std::filesystem::path recipe;
  std::filesystem::path out;
  std::vector<std::string> servers = {ClientOptions().server_address};
  ServerArguments connection;  // the address is unused
  std::optional<batch::Shard> shard;
  batch::RecipeOverrides overrides;
  int max_in_flight = batch::flow::Options().max_in_flight;
  int channels = 1;
  double patience_seconds = 120;
  int64_t limit = std::numeric_limits<int64_t>::max();
  double share = 1;
  batch::Repeats repeats;
  batch::AllowedFailures allow_failed;
  bool dry_run = false;
  bool json = false;
  bool quiet = false;
};

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_ARGUMENTS_H_
