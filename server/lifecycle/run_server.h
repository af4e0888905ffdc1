#ifndef DUET_SERVER_LIFECYCLE_RUN_SERVER_H_
#define DUET_SERVER_LIFECYCLE_RUN_SERVER_H_

#include <memory>

#include "server/lifecycle/process_end.h"
#include "server/lifecycle/validate_settings.h"
#include "server/metrics/log_sink.h"
#include "server/registry/model_repository.h"

namespace duet::server::lifecycle {

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
