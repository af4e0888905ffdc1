#ifndef DUET_SERVER_LIFECYCLE_LOAD_MODELS_H_
#define DUET_SERVER_LIFECYCLE_LOAD_MODELS_H_

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "duet/v1/server_config.pb.h"
#include "server/common/mutex.h"
#include "server/metrics/json_log.h"
#include "server/metrics/server_metrics.h"
#include "server/registry/model_manager.h"
#include "server/registry/model_registry.h"
#include "server/registry/model_repository.h"

namespace duet::server::lifecycle {

// Gives the manager the labels of the settings.
void ConfigureModels(const v1::ServerConfig& settings, registry::ModelManager& manager);

// Loads the models of the repository, or the embedded ones without a repository, until `stop`
// returns true. The observer reports checkpoints that do not load; the result has other problems,
// one line each. With SERVED_MODELS_FREE, a model that is not free for all uses is not served,
// neither now nor later. Fails if the repository cannot be read or is empty, and with CANCELLED if
// it was stopped.
absl::StatusOr<std::vector<std::string>> LoadModels(const v1::ServerConfig& settings,
                                                    const registry::ModelSource& source,
                                                    const std::function<bool()>& stop,
                                                    registry::ModelManager& manager,
                                                    registry::ModelRegistry& registry);

// Sets the default model and the labels after models were loaded. Returns the labels that cannot be
// set now because their versions are not served.
// Fails with FAILED_PRECONDITION if no model is served, NOT_FOUND if the default model is not
// served, and INVALID_ARGUMENT if labels name models that do not exist.
absl::StatusOr<std::vector<std::string>> SettleModels(const v1::ServerConfig& settings,
                                                      registry::ModelManager& manager,
                                                      registry::ModelRegistry& registry);

// Reports loading and unloading of models to the log and the metrics.
//
// Threads: safe to call concurrently.
class ModelEvents final : public registry::ModelObserver {
 public:
  // Both outlive this object. `changed` is called when the served models may have changed.
  ModelEvents(metrics::JsonLog& log, metrics::ServerMetrics& metrics, std::function<void()> changed)
      : log_(log), metrics_(metrics), changed_(std::move(changed)) {}

  void Loaded(const registry::LoadReport& report, bool still_served) override;
  void Unloaded(const std::string& source) override;
  void Forgotten(const std::string& source) override;
  // Logs a folder that is skipped repeatedly only once.
  void Scanned(const std::vector<registry::SkippedFolder>& skipped) override;
  void Reloaded(const absl::StatusOr<registry::ReloadReport>& report) override;
  void Changed() override { changed_(); }

 private:
  metrics::JsonLog& log_;
  metrics::ServerMetrics& metrics_;
  const std::function<void()> changed_;
  common::Mutex mutex_;
  std::vector<registry::SkippedFolder> logged_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_LOAD_MODELS_H_
