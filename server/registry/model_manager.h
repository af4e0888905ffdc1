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
#include "server/common/mutex.h"
#include "server/registry/checkpoint_fingerprint.h"
#include "server/registry/model_registry.h"
#include "server/registry/model_repository.h"
#include "server/registry/model_status.h"
#include "server/registry/version_label.h"
#include "server/registry/version_policy.h"

namespace duet::server::registry {

// Keeps what is served in line with a repository of checkpoints.
//
// A version is loaded and checked beside the one that is served, then takes its place: calls under
// way finish on what they began with, and no call finds a gap. A checkpoint that does not load
// changes nothing. A version is let go only after those in its stead are there, and never while a
// version label points at it or the default model would be left without any.
//
// Threads: safe to call concurrently. What loads (Reload, Load) does so on the calling thread, one
// at a time; List and labels never wait for that.
class ModelManager {
 public:
  // Both outlive the manager.
  ModelManager(ModelRegistry& registry, ModelObserver& observer)
      : registry_(registry), observer_(observer) {}

  // Where checkpoints are and what loads them. Without a repository, what Add gets is served and
  // nothing can be loaded or unloaded.
  void UseRepository(std::filesystem::path repository, ModelLoader loader);
  // Counts from the next Reload on.
  void SetPolicies(std::vector<VersionPolicy> policies);
  // The labels of the configuration. The next Reload, or ApplyLabels, moves those that are not as
  // they were configured before and deletes those that are gone; others stay where the operator
  // moved them.
  void SetLabels(std::vector<VersionLabel> labels);

  // Serves a loaded model, or remembers why it is not.
  void Add(const LoadReport& report);

  // Loads what is new or has changed in the repository and what failed before, as the policies,
  // labels and the operator's own wishes have it; lets go of what is no longer wanted. Stops before
  // the next checkpoint when `stop` gives true. Fails, and changes nothing, when the repository
  // cannot be read or there is nothing in it.
  absl::StatusOr<ReloadReport> Reload(const std::function<bool()>& stop);

  // Loads a version even if no policy wants it or it is served already; it stays whatever the
  // policies say. NOT_FOUND when the repository does not have it, FAILED_PRECONDITION with the
  // reason when it does not load or there is no repository.
  absl::Status Load(absl::string_view name, uint32_t version);

  // Serves a version no longer; it stays away until it is loaded by name. NOT_FOUND when it is not
  // served, FAILED_PRECONDITION when a label or the default needs it or there is no repository.
  absl::Status Unload(absl::string_view name, uint32_t version);

  // Brings labels in line with the configuration. Returns which could not be set, and why: their
  // versions are not served. They are tried again next time.
  std::vector<std::string> ApplyLabels();

  // One line for each label and policy of the configuration that names a model that is neither in
  // the repository nor served: the field, the names there are, and the name that came.
  std::vector<std::string> UnknownNames() const;

  // Every version that was ever looked at and is still there, by name, newest first.
  std::vector<ModelStatus> List() const;
  // Of the repository, when it was looked through last.
  std::vector<SkippedFolder> skipped() const;
  // Whether there is a model of that name, served or not.
  bool Knows(absl::string_view name) const;

 private:
  // What the operator wants, whatever the policies say.
  enum class Wish { kAsThePolicySays, kLoaded, kUnloaded };
  struct Version {
    bool served = false;
    bool loading = false;
    Wish wish = Wish::kAsThePolicySays;
    std::string error;                  // of its last load; empty after a success
    CheckpointFingerprint fingerprint;  // of what is served
    double load_seconds = 0;
  };
  using Versions = std::map<uint32_t, Version, std::greater<>>;
  // Checkpoint folders by name and version.
  using Folders =
      std::map<std::string, std::map<uint32_t, std::filesystem::path, std::greater<>>, std::less<>>;

  absl::StatusOr<Folders> Scan();
  // One model's part of a reload. False when it was stopped.
  bool ReloadModel(const std::string& name, const Folders::mapped_type& folders,
                   const std::function<bool()>& stop, ReloadReport& report);
  // Of one model; empty: of each.
  std::vector<std::string> ApplyLabelsOf(absl::string_view name);
  // Whether policy or operator want a version. `places`: for how many the policy still has room.
  bool IsWanted(const std::string& name, uint32_t version, const VersionPolicy& policy,
                uint32_t places) const;
  // Lists a version that is there and not wanted.
  void PassOver(const std::string& name, uint32_t version);
  // Forgets every version of a model that has neither a folder nor is served.
  void ForgetWithout(const Folders::mapped_type& folders, const std::string& name);
  // Null if the version was never looked at.
  const Version* Find(const std::string& name, uint32_t version) const DUET_REQUIRES(mutex_);
  Wish WishFor(const std::string& name, uint32_t version) const;
  // Whether a label points at a version, or is to as the configuration has it.
  bool IsLabelled(const std::string& name, uint32_t version) const;
  bool WillBeLabelled(const std::string& name, uint32_t version) const;
  // Whether what is served is what lies in `folder`. A version whose last load failed is not, even
  // if its old files are back: only a load that succeeds settles that.
  bool IsUnchanged(const std::string& name, uint32_t version, const std::filesystem::path& folder);
  absl::Status LoadFolder(const std::string& name, uint32_t version,
                          const std::filesystem::path& folder);
  void Take(const std::string& name, uint32_t version, const LoadReport& report,
            CheckpointFingerprint fingerprint);
  void Retire(const std::string& name, uint32_t version, ReloadReport& report);
  std::vector<uint32_t> ServedVersions(const std::string& name) const;
  absl::Status CheckRepository() const;

  ModelRegistry& registry_;
  ModelObserver& observer_;

  common::Mutex work_mutex_;  // held by who loads or unloads
  mutable common::Mutex mutex_;
  std::filesystem::path repository_ DUET_GUARDED_BY(mutex_);
  ModelLoader loader_ DUET_GUARDED_BY(mutex_);
  std::vector<VersionPolicy> policies_ DUET_GUARDED_BY(mutex_);
  std::vector<VersionLabel> labels_ DUET_GUARDED_BY(mutex_);          // of the configuration
  std::vector<VersionLabel> applied_labels_ DUET_GUARDED_BY(mutex_);  // of those, the ones set
  std::map<std::string, Versions, std::less<>> models_ DUET_GUARDED_BY(mutex_);
  std::vector<SkippedFolder> skipped_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_MODEL_MANAGER_H_
