#ifndef DUET_SERVER_LIFECYCLE_RUN_SERVER_H_
#define DUET_SERVER_LIFECYCLE_RUN_SERVER_H_

#include <memory>

#include "server/lifecycle/stop_signal.h"
#include "server/lifecycle/validate_settings.h"
#include "server/metrics/log_sink.h"
#include "server/registry/model_source.h"

namespace duet::server::lifecycle {

using registry::ModelSource;

// Exit codes of duet-server.
inline constexpr int kExitStopped =
    0;                                 // drained after SIGTERM or SIGINT, or nothing to complain of
inline constexpr int kExitFailed = 1;  // a file, an address or a model that settings name is wrong
inline constexpr int kExitUsage = 2;   // a flag or the configuration file is wrong

// Everything that duet-server does, from the command line to the exit code: listen, load, serve,
// reload on SIGHUP, drain. `stop` was constructed before any thread. A `sink` that is slow or stuck
// holds up nothing but the log.
int RunServer(int argc, const char* const* argv, const EngineOpener& open_engine, StopSignal& stop,
              std::shared_ptr<metrics::LogSink> sink);

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_RUN_SERVER_H_
