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
#include "server/config/server_options.h"
#include "server/config/setting_sources.h"

namespace duet::server::config {

// Parses a configuration file's text: JSON or text format. Unknown fields are refused.
// Fails with INVALID_ARGUMENT saying where and why.
absl::StatusOr<v1::ServerConfig> ParseConfigText(std::string_view text, bool json);

// Replaces `config` by what a configuration file says, where it fails by what could be read of it;
// ".json" is JSON, anything else text format. `places` receives where the file sets what.
// Fails with NOT_FOUND, or INVALID_ARGUMENT with one line for each thing that is wrong; each line
// names the file.
absl::Status ReadConfigFile(const std::filesystem::path& path, v1::ServerConfig* config,
                            messages::FieldPlaces* places);

// What a command line asks for, together with the environment and the configuration file.
struct CommandLine {
  enum class Task {
    kServe,
    kCheckConfig,  // load everything, say what is wrong, and leave
    kPrintConfig,  // print every setting with where it comes from, and leave
  };
  Task task = Task::kServe;
  // Of the file, overridden by the environment, overridden by the flags. Values of a repeated field
  // come one after the other.
  v1::ServerConfig config;
  SettingSources sources;
  // All that is wrong with flags, variables and the file, for people. What `config` lacks for it
  // has its default.
  std::vector<std::string> errors;
  std::optional<std::string> print;  // --help or --version
};

// Reads the flags, the variables (DUET_SERVER_MAX_CALLS for --max-calls; of a flag that may be
// repeated the values with spaces between them) and, where --config or DUET_SERVER_CONFIG names
// one, the file.
CommandLine ParseCommandLine(int argc, const char* const* argv,
                             const Environment& environment = {});

// The settings, checked, with everything that is wrong with flags, variables, the file and the
// values they set. `cores` and `memory_bytes` are what the container may use.
Settings ReadSettings(const CommandLine& command_line, int cores,
                      std::uint64_t memory_bytes = kUnlimitedMemory);

// The same, failing with INVALID_ARGUMENT and all mistakes.
absl::StatusOr<ServerOptions> ToOptions(const CommandLine& command_line, int cores,
                                        std::uint64_t memory_bytes = kUnlimitedMemory);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_LOAD_CONFIG_H_
