#ifndef DUET_SERVER_LIFECYCLE_MODEL_EVENTS_H_
#define DUET_SERVER_LIFECYCLE_MODEL_EVENTS_H_

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "server/common/mutex.h"
#include "server/metrics/json_log.h"
#include "server/metrics/server_metrics.h"
#include "server/registry/model_status.h"

namespace duet::server::lifecycle {

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

#endif  // DUET_SERVER_LIFECYCLE_MODEL_EVENTS_H_
