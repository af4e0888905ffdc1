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
  std::function<absl::Status()> reload;  // on failure what was there before stays
  // OK, or why what is on disk is not in use; quick, safe to call concurrently. Null: as the last
  // reload left it.
  std::function<absl::Status()> state = nullptr;
};

// What an operator may do to models while calls are answered, by signal or admin call. Whatever
// loads does so on a thread of its own with a small share of the processors.
//
// Threads: safe to call concurrently. Nothing here waits but the destructor, for the load under
// way.
class ModelControl {
 public:
  using ReloadDone = std::function<void(const absl::StatusOr<ReloadReport>&)>;
  using Done = std::function<void(const absl::Status&)>;

  // All outlive it.
  ModelControl(ModelManager& manager, ModelRegistry& registry, ModelObserver& observer)
      : manager_(manager), registry_(registry), observer_(observer) {}

  // From the next Reload on.
  void AddReloadable(Reloadable reloadable);

  // As ModelManager's; before it everything that is reloadable is read again. Each calls `done`
  // once: on the thread that loads, or with CANCELLED when the server stops first.
  void Reload(ReloadDone done);
  void Load(std::string name, uint32_t version, Done done);
  void Unload(std::string name, uint32_t version, Done done);

  // As ModelRegistry's.
  absl::Status SetLabel(const std::string& name, const std::string& label, uint32_t version);
  absl::Status DeleteLabel(const std::string& name, const std::string& label);
  std::vector<ModelStatus> List() const { return manager_.List(); }
  std::vector<SkippedFolder> skipped() const { return manager_.skipped(); }
  // "name: why" for everything reloadable whose content on disk was refused, and for the repository
  // if the last reload could not read it; what was read before is still in use.
  std::vector<std::string> problems() const;

  // Begins nothing further that loads.
  void Stop() { thread_.Stop(); }

 private:
  struct Entry {
    Reloadable reloadable;
    absl::Status last;  // of its last reload
  };

  absl::StatusOr<ReloadReport> ReloadNow();
  // Reads everything but models again.
  void ReloadOthers();
  std::vector<Entry> entries() const;
  // Calls `work` on the thread that loads, and `done` with what it gives.
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
