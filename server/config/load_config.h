#ifndef DUET_SERVER_CONFIG_LOAD_CONFIG_H_
#define DUET_SERVER_CONFIG_LOAD_CONFIG_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "duet/v1/server_config.pb.h"
#include "model/messages/field_places.h"
#include "server/config/environment.h"
#include "server/config/flag_parser.h"
#include "server/config/settings.h"

namespace duet::server::config {

// Parses the text of a configuration file: JSON or text format. Unknown fields are rejected.
// Fails with INVALID_ARGUMENT, the place and the reason.
absl::StatusOr<v1::ServerConfig> ParseConfigText(std::string_view text, bool json);

// Replaces `config` by the content of a configuration file: JSON if its name ends in ".json",
// otherwise text format. `places` receives the place of each field that the file sets. After a
// failure `config` has the fields that could be read.
// Fails with NOT_FOUND, or with INVALID_ARGUMENT and one line for each mistake; each line names the
// file.
absl::Status ReadConfigFile(const std::filesystem::path& path, v1::ServerConfig* config,
                            messages::FieldPlaces* places);

// What a command line requests, merged with the environment and the configuration file.
struct CommandLine {
  using Task = config::Task;
  Task task = Task::kServe;
  // The file, overridden by the environment, overridden by the flags. Values of a repeated field
  // are concatenated in that order.
  v1::ServerConfig config;
  SettingSources sources;
  // Every mistake in flags, variables and the file. A field with a mistake is absent from `config`.
  std::vector<std::string> errors;
  std::optional<std::string> print;  // the text of --help or --version
};

// Reads the flags, the variables (DUET_SERVER_MAX_CALLS for --max-calls; the values of a flag that
// may be repeated are separated by spaces) and the file that --config or DUET_SERVER_CONFIG names.
CommandLine ParseCommandLine(int argc, const char* const* argv,
                             const Environment& environment = {});

// Resolves the settings of a command line. The mistakes are those of flags, variables, the file and
// the values. `cores` and `memory_bytes` are what the container may use.
Settings ReadSettings(const CommandLine& command_line, int cores,
                      std::uint64_t memory_bytes = kUnlimitedMemory);

// Returns only the values. Fails with INVALID_ARGUMENT and every mistake.
absl::StatusOr<v1::ServerConfig> ResolveSettings(const CommandLine& command_line, int cores,
                                                 std::uint64_t memory_bytes = kUnlimitedMemory);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_LOAD_CONFIG_H_
