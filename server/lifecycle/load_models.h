#ifndef DUET_SERVER_LIFECYCLE_LOAD_MODELS_H_
#define DUET_SERVER_LIFECYCLE_LOAD_MODELS_H_

#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/config/server_options.h"
#include "server/registry/model_manager.h"
#include "server/registry/model_registry.h"
#include "server/registry/model_source.h"

namespace duet::server::lifecycle {

// Labels and policies as the options have them.
void ConfigureModels(const config::ServerOptions& options, registry::ModelManager& manager);

// Loads what the options name, the repository's models or those inside the program, until `stop`
// gives true. Returns what could not be done; a checkpoint that does not load is the observer's to
// tell. Fails when the repository cannot be read or is empty, with CANCELLED when it was stopped.
absl::StatusOr<std::vector<std::string>> LoadModels(const config::ServerOptions& options,
                                                    const registry::ModelSource& source,
                                                    const std::function<bool()>& stop,
                                                    registry::ModelManager& manager,
                                                    registry::ModelRegistry& registry);

// Sets default model and labels once models are there. Returns the labels that cannot be set now
// because their versions are not served.
// Fails with FAILED_PRECONDITION when nothing is served, NOT_FOUND when the default model is not,
// and INVALID_ARGUMENT when labels or policies name models that there are not.
absl::StatusOr<std::vector<std::string>> SettleModels(const config::ServerOptions& options,
                                                      registry::ModelManager& manager,
                                                      registry::ModelRegistry& registry);

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_LOAD_MODELS_H_
