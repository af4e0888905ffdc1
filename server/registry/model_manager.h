#ifndef DUET_SERVER_REGISTRY_MODEL_MANAGER_H_
#define DUET_SERVER_REGISTRY_MODEL_MANAGER_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "server/common/background_thread.h"
#include "server/common/mutex.h"
#include "server/registry/model_registry.h"
#include "server/registry/model_repository.h"

namespace duet::server::registry {

// Synchronises the served models with a repository of checkpoints.
//
// A version is loaded and checked while the previous one is still served, and then replaces it.
// Calls in progress keep the model that they started with, and the model is always available. A
// checkpoint that does not load changes nothing. A version is removed only after its replacements
// are served, and never while a version label points to it or it is the last version of the default
// model.
//
// Threads: safe to call concurrently. Reload and Load run on the calling thread, one at a time.
// List and
//          the methods for labels do not wait for them.
class ModelManager {
 public:
  // Both outlive the manager.
  ModelManager(ModelRegistry& registry, ModelObserver& observer)
      : registry_(registry), observer_(observer) {}

  // Sets the repository and the loader. Without a repository, only models passed to Add are served,
  // and nothing can be loaded or unloaded.
  void UseRepository(std::filesystem::path repository, ModelLoader loader);
  // Sets the configured labels. The next Reload or ApplyLabels moves the labels whose configuration
  // has changed and deletes those that were removed from it. Other labels keep the version that the
  // operator assigned.
  void SetLabels(std::vector<VersionLabel> labels);

  // Serves a loaded model, or records why it failed to load.
  void Add(const LoadReport& report);

  // Loads new and changed checkpoints and those that failed before, except those that the operator
  // unloaded, and removes versions whose folders are gone. Stops before the next checkpoint if
  // `stop` returns true. Fails, without changes, if the repository cannot be read or is empty.
  absl::StatusOr<ReloadReport> Reload(const std::function<bool()>& stop);

  // Loads a version even if it is already served. Returns NOT_FOUND if the repository does not
  // contain it, and FAILED_PRECONDITION with the reason if it does not load or there is no
  // repository.
  absl::Status Load(absl::string_view name, uint32_t version);

  // Stops serving a version until Load is called for it. Returns NOT_FOUND if it is not served, and
  // FAILED_PRECONDITION if a label or the default model needs it or there is no repository.
  absl::Status Unload(absl::string_view name, uint32_t version);

  // Applies the configured labels. Returns the labels whose versions are not served, with the
  // reason. The next call retries them.
  std::vector<std::string> ApplyLabels();

  // Returns one line for each configured label whose model is neither in the repository
  // nor served: the field, the known names, and the unknown name.
  std::vector<std::string> UnknownNames() const;

  // Returns every known version that still exists, by name, newest first.
  std::vector<ModelStatus> List() const;
  // Returns the folders that the last scan of the repository skipped.
  std::vector<SkippedFolder> skipped() const;

 private:
  struct Version {
    bool served = false;
    bool loading = false;
    bool unloaded = false;  // by the operator
    std::string error;      // of the last load; empty if it succeeded
    std::string files;      // FilesOf what is served; empty if unknown
    double load_seconds = 0;
  };
  using Versions = std::map<uint32_t, Version, std::greater<>>;
  // Checkpoint folders by name and version.
  using Folders =
      std::map<std::string, std::map<uint32_t, std::filesystem::path, std::greater<>>, std::less<>>;

  absl::StatusOr<Folders> Scan();
  // Reloads one model. Returns false if it was stopped.
  bool ReloadModel(const std::string& name, const Folders::mapped_type& folders,
                   const std::function<bool()>& stop, ReloadReport& report);
  // ApplyLabels for one model; if empty, for every model.
  std::vector<std::string> ApplyLabelsOf(absl::string_view name);
  // Forgets every version of a model that has no folder and is not served.
  void ForgetWithout(const Folders::mapped_type& folders, const std::string& name);
  // A copy, so that it can be used without the lock.
  Versions VersionsOf(const std::string& name) const;
  // Returns true if the served version is the one in `folder`. Returns false if the last load
  // failed, even if the previous files were restored: only a successful load clears the error.
  static bool IsUnchanged(const Version& known, const std::filesystem::path& folder);
  absl::Status LoadFolder(const std::string& name, uint32_t version,
                          const std::filesystem::path& folder);
  void Take(const std::string& name, uint32_t version, const LoadReport& report,
            const std::string& files);
  // Stops serving a version: one that an operator unloads is not loaded again by a reload.
  absl::Status Remove(const std::string& name, uint32_t version, bool by_operator);
  absl::Status CheckRepository() const;

  ModelRegistry& registry_;
  ModelObserver& observer_;

  common::Mutex work_mutex_;  // held while loading or unloading
  mutable common::Mutex mutex_;
  std::filesystem::path repository_ DUET_GUARDED_BY(mutex_);
  ModelLoader loader_ DUET_GUARDED_BY(mutex_);
  std::vector<VersionLabel> labels_ DUET_GUARDED_BY(mutex_);          // of the configuration
  std::vector<VersionLabel> applied_labels_ DUET_GUARDED_BY(mutex_);  // of those, the ones set
  std::map<std::string, Versions, std::less<>> models_ DUET_GUARDED_BY(mutex_);
  std::vector<SkippedFolder> skipped_ DUET_GUARDED_BY(mutex_);
};

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
  ModelControl(ModelManager& manager, ModelObserver& observer)
      : manager_(manager), observer_(observer) {}

  // Takes effect with the next Reload.
  void AddReloadable(Reloadable reloadable);

  // Like the methods of ModelManager, but asynchronous. Reload reads everything reloadable first.
  // Each calls `done` once, on the loading thread, with CANCELLED if the server stops first.
  void Reload(ReloadDone done);
  void Load(std::string name, uint32_t version, Done done);
  void Unload(std::string name, uint32_t version, Done done);

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
  ModelObserver& observer_;
  mutable common::Mutex mutex_;
  std::vector<Entry> entries_ DUET_GUARDED_BY(mutex_);
  absl::Status repository_ DUET_GUARDED_BY(mutex_);  // of the last reload
  common::BackgroundThread thread_{common::BackgroundThread::Share::kSmall};
};

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_MODEL_MANAGER_H_
