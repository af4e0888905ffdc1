#ifndef DUET_SERVER_REGISTRY_MODEL_CONTROL_H_
#define DUET_SERVER_REGISTRY_MODEL_CONTROL_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/common/background_thread.h"
#include "server/common/mutex.h"
#include "server/registry/model_manager.h"

namespace duet::server::registry {

// Something besides models that a reload reads again, such as certificates.
struct Reloadable {
  std::string name;                      // for the log: "certificates"
  std::function<absl::Status()> reload;  // if it fails, the previous content stays in use
  // Returns OK, or why the content on disk is not in use. Must be fast and safe to call
  // concurrently. Null: the status of the last reload.
  std::function<absl::Status()> state = nullptr;
};

// Changes models on behalf of the operator, by signal or admin call, while the server handles
// calls. Models are loaded on a separate thread with low priority.
//
// Threads: safe to call concurrently. No method blocks, except the destructor, which waits for a
//          load in progress.
class ModelControl {
 public:
  using ReloadDone = std::function<void(const absl::StatusOr<ReloadReport>&)>;
  using Done = std::function<void(const absl::Status&)>;

  // The arguments outlive it.
  ModelControl(ModelManager& manager, ModelRegistry& registry, ModelObserver& observer)
      : manager_(manager), registry_(registry), observer_(observer) {}

  // Takes effect with the next Reload.
  void AddReloadable(Reloadable reloadable);

  // Like the methods of ModelManager, but asynchronous. Reload reads everything reloadable first.
  // Each calls `done` once, on the loading thread, with CANCELLED if the server stops first.
  void Reload(ReloadDone done);
  void Load(std::string name, uint32_t version, Done done);
  void Unload(std::string name, uint32_t version, Done done);

  // Like the methods of ModelRegistry.
  absl::Status SetLabel(const std::string& name, const std::string& label, uint32_t version);
  absl::Status DeleteLabel(const std::string& name, const std::string& label);
  std::vector<ModelStatus> List() const { return manager_.List(); }
  std::vector<SkippedFolder> skipped() const { return manager_.skipped(); }
  // Returns "name: reason" for everything reloadable whose content on disk was rejected, and for
  // the repository if the last reload could not read it. The previous content is still in use.
  std::vector<std::string> problems() const;

  // Starts no further loads.
  void Stop() { thread_.Stop(); }

 private:
  struct Entry {
    Reloadable reloadable;
    absl::Status last;  // of its last reload
  };

  absl::StatusOr<ReloadReport> ReloadNow();
  // Reads everything reloadable except models.
  void ReloadOthers();
  std::vector<Entry> entries() const;
  // Calls `work` on the loading thread, then `done` with its result.
  void Post(std::function<absl::Status()> work, Done done);

  ModelManager& manager_;
  ModelRegistry& registry_;
  ModelObserver& observer_;
  mutable common::Mutex mutex_;
  std::vector<Entry> entries_ DUET_GUARDED_BY(mutex_);
  absl::Status repository_ DUET_GUARDED_BY(mutex_);  // of the last reload
  common::BackgroundThread thread_{common::BackgroundThread::Share::kSmall};
};

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_MODEL_CONTROL_H_
