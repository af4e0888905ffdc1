#ifndef DUET_SERVER_LIFECYCLE_CHECK_CONFIG_H_
#define DUET_SERVER_LIFECYCLE_CHECK_CONFIG_H_

#include <ostream>

#include "server/lifecycle/validate_settings.h"

namespace duet::server::lifecycle {

// Loads the models that the settings name, by the code that a server loads them with, and writes a
// line for each model and for each mistake: those of the settings, checkpoints that do not load,
// folders that are none, labels that point nowhere. Listens nowhere. A line for settings that do
// not fit the memory is a warning, which does not count.
//
// Returns the exit code: kExitUsage for mistakes in settings, kExitFailed for any others.
int CheckConfig(const ValidatedSettings& settings, std::ostream& out);

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_CHECK_CONFIG_H_
