#ifndef DUET_SERVER_LIFECYCLE_VALIDATE_SETTINGS_H_
#define DUET_SERVER_LIFECYCLE_VALIDATE_SETTINGS_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/config/load_config.h"
#include "server/config/server_options.h"
#include "server/registry/model_source.h"

namespace duet::server::lifecycle {

// Opens the engine that the options ask for. Only the main program knows which ones there are.
// Fails when it is not to be had here: "field: expected ..., got ...; hint".
using EngineOpener =
    std::function<absl::StatusOr<registry::ModelSource>(const config::EngineOptions&)>;

// What an operator has set, and every mistake in it: a line for each.
struct ValidatedSettings {
  config::ServerOptions options;                 // of fields that are wrong, some other value
  absl::StatusOr<registry::ModelSource> source;  // fails if a mistake keeps it from being opened
  // Of flags, variables, the configuration file, the values they set, and the engine.
  std::vector<std::string> setting_mistakes;
  // Of what the settings name: certificates, the access file, addresses to listen on.
  std::vector<std::string> resource_mistakes;
};

// Whether somebody may listen on the ports of the settings: the server that these settings are for,
// when they are checked beside it.
enum class Ports { kFree, kMayBeInUse };

// The one check of settings, for a start and for --check-config. Models come after it. `cores` and
// `memory_bytes` are what the container may use.
ValidatedSettings ValidateSettings(const config::CommandLine& command_line, int cores,
                                   std::uint64_t memory_bytes, const EngineOpener& open_engine,
                                   Ports ports);

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_VALIDATE_SETTINGS_H_
