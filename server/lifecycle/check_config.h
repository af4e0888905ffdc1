#ifndef DUET_SERVER_LIFECYCLE_CHECK_CONFIG_H_
#define DUET_SERVER_LIFECYCLE_CHECK_CONFIG_H_

#include <ostream>

#include "server/lifecycle/validate_settings.h"

namespace duet::server::lifecycle {

// Loads the models that the settings name, with the code of a server start, and writes one line for
// each model and for each mistake: mistakes in settings, checkpoints that do not load, folders that
// are not checkpoints, labels that point nowhere. Does not listen. Settings that do not fit the
// memory cause a warning, which is not a mistake.
//
// Returns the exit code: kExitUsage for mistakes in settings, kExitFailed for any other.
int CheckConfig(const ValidatedSettings& settings, std::ostream& out);

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_CHECK_CONFIG_H_
