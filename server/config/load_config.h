#ifndef DUET_SERVER_CONFIG_LOAD_CONFIG_H_
#define DUET_SERVER_CONFIG_LOAD_CONFIG_H_

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "duet/v1/server_config.pb.h"
#include "model/messages/message_text.h"
#include "server/config/settings.h"

namespace duet::server::config {

// Replaces `config` by the content of a configuration file: JSON if its name ends in ".json",
// otherwise text format. `places` receives the place of each field that the file sets. After a
// failure `config` has the fields that could be read.
// Fails with NOT_FOUND, or with INVALID_ARGUMENT and one line for each mistake; each line names the
// file.
absl::Status ReadConfigFile(const std::filesystem::path& path, v1::ServerConfig* config,
                            messages::FieldPlaces* places);

// Environment variables by name.
using Environment = std::map<std::string, std::string>;

// Returns the variables, of a null-terminated array of "NAME=value" such as environ, that begin
// with "DUET_SERVER_", except those that Kubernetes sets in every container beside a Service named
// duet-server: DUET_SERVER_SERVICE_HOST, DUET_SERVER_PORT_50051_TCP and the like.
Environment ReadEnvironment(const char* const* variables);

// What the program is started for.
enum class Task {
  kServe,
  kCheckConfig,  // load everything, report every mistake, and exit
  kPrintConfig,  // print every setting and its source, and exit
  kCheckHealth,  // ask the running server whether it is healthy, and exit
};

// What a command line requests, merged with the environment and the configuration file.
struct CommandLine {
  Task task = Task::kServe;
  // The file, overridden by the environment, overridden by the flags. Values of a repeated field
  // are concatenated in that order.
  v1::ServerConfig config;
  SettingSources sources;
  // Every mistake in flags, variables and the file; of flags that do not exist or lack a value,
  // only the first. A field with a mistake is absent from `config`.
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

// Formats every setting with its value and source as a configuration file in text format:
//   max_calls: 64  # file duet.textproto:3:1
//   drain_seconds: 0  # default
std::string PrintConfig(const v1::ServerConfig& settings, const SettingSources& sources);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_LOAD_CONFIG_H_
