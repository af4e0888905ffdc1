#ifndef DUET_SERVER_LIFECYCLE_RUN_SERVER_H_
#define DUET_SERVER_LIFECYCLE_RUN_SERVER_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "duet/v1/server_config.pb.h"
#include "server/config/load_config.h"
#include "server/config/settings.h"
#include "server/lifecycle/process_end.h"
#include "server/metrics/log_sink.h"
#include "server/registry/model_repository.h"

namespace duet::server::lifecycle {

// Opens the engine as the settings choose. Only the main program names an engine.
// Fails if the engine is not available here: "field: expected ..., got ...; hint".
using EngineOpener = std::function<absl::StatusOr<registry::ModelSource>(const v1::ServerConfig&)>;

// The resolved settings of an operator, and every mistake in them: one line each.
struct ValidatedSettings {
  v1::ServerConfig values;                       // a field with a mistake has some valid value
  absl::StatusOr<registry::ModelSource> source;  // fails if a mistake prevents opening the engine
  // In flags, variables, the configuration file, the values they set, and the engine.
  std::vector<std::string> setting_mistakes;
  // In what the settings name: certificates, the access file, addresses to listen on.
  std::vector<std::string> resource_mistakes;
};

// The one check of settings, for a start and for --check-config, which may run beside a server with
// these settings: a port in use is no mistake. Models are checked after it.
// `cores` and `memory_bytes` are what the container may use.
ValidatedSettings ValidateSettings(const config::CommandLine& command_line, int cores,
                                   std::uint64_t memory_bytes, const EngineOpener& open_engine);

// Loads the models that the settings name, with the code of a server start, and writes one line for
// each model and for each mistake: mistakes in settings, checkpoints that do not load, folders that
// are not checkpoints, labels that point nowhere. Does not listen. Settings that do not fit the
// memory cause a warning, which is not a mistake.
//
// Returns the exit code: kExitUsage for mistakes in settings, kExitFailed for any other.
int CheckConfig(const ValidatedSettings& settings, std::ostream& out);

using registry::ModelSource;

// Runs duet-server from the command line to the exit code: listen, load, serve, reload on SIGHUP,
// drain. If a thread hangs, the process ends with kExitStuck or kExitLate and this function does
// not return.
//
// `stop` is never destroyed: it limits the time until the process has exited. A slow or stuck
// `sink` delays only the log.
int RunServer(int argc, const char* const* argv, const EngineOpener& open_engine, StopSignal& stop,
              std::shared_ptr<metrics::LogSink> sink);

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_RUN_SERVER_H_
