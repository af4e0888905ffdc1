#ifndef DUET_SERVER_CONFIG_LOAD_CONFIG_H_
#define DUET_SERVER_CONFIG_LOAD_CONFIG_H_

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "duet/v1/server_config.pb.h"

namespace duet::server::config {

// Parses a configuration file's text: JSON or text format. Unknown fields are refused.
// Fails with INVALID_ARGUMENT saying where and why.
absl::StatusOr<v1::ServerConfig> ParseConfigText(std::string_view text, bool json);

// Reads a configuration file; ".json" is JSON, anything else text format.
// Fails with NOT_FOUND, or INVALID_ARGUMENT; both name the file.
absl::StatusOr<v1::ServerConfig> ReadConfigFile(const std::filesystem::path& path);

// What a command line asks for: a configuration, or to print something and leave.
struct CommandLine {
  v1::ServerConfig config;           // the file's, overridden by the flags
  std::optional<std::string> print;  // --help or --version
};

// Reads the flags and, where --config names one, the file.
// Fails with INVALID_ARGUMENT naming the flag, or as ReadConfigFile.
absl::StatusOr<CommandLine> ParseCommandLine(int argc, const char* const* argv);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_LOAD_CONFIG_H_
