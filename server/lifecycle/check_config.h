#ifndef DUET_SERVER_LIFECYCLE_CHECK_CONFIG_H_
#define DUET_SERVER_LIFECYCLE_CHECK_CONFIG_H_

#include <ostream>

#include "server/config/server_options.h"
#include "server/registry/model_source.h"

namespace duet::server::lifecycle {

// Loads everything that the options name without listening anywhere, and writes a line for each
// model and for each thing that is not as it should be: certificates and access files that a server
// would not start with, checkpoints that do not load, folders that are none, labels that point
// nowhere. True when there is no such thing. A line for settings that do not fit the memory is a
// warning, which does not count.
bool CheckConfig(const config::ServerOptions& options, const registry::ModelSource& source,
                 std::ostream& out);

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_CHECK_CONFIG_H_
