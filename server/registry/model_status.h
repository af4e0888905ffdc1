#ifndef DUET_SERVER_REGISTRY_MODEL_STATUS_H_
#define DUET_SERVER_REGISTRY_MODEL_STATUS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/registry/model_repository.h"

namespace duet::server::registry {

// A name that requests may use instead of a version number: "stable", "canary".
struct VersionLabel {
  std::string model;
  std::string label;
  uint32_t version = 0;
  friend bool operator==(const VersionLabel& a, const VersionLabel& b) {
    return a.model == b.model && a.label == b.label && a.version == b.version;
  }
};

// State of a version that is or was in the repository.
enum class ModelState {
  kLoading,   // for the first time; a version stays kServed while it is reloaded
  kServed,    // available to calls
  kFailed,    // could not be loaded
  kUnloaded,  // in the repository, but excluded by the operator
};

struct ModelStatus {
  std::string name;
  uint32_t version = 0;
  ModelState state = ModelState::kUnloaded;
  bool is_default = false;
  std::vector<std::string> version_labels;  // sorted
  // Why the last load failed; empty if it succeeded. If an earlier load is still served, `outdated`
  // is true.
  std::string error;
  bool outdated = false;
  double load_seconds = 0;  // of the load that is served
};

// Result of a reload. Versions are written "<name>/<version>".
struct ReloadReport {
  std::vector<std::string> loaded;    // new or replaced
  std::vector<std::string> refused;   // ModelStatus::error has the reason
  std::vector<std::string> unloaded;  // removed from the repository
  int unchanged = 0;
  std::vector<std::string> refused_labels;  // whose versions are not served
  std::vector<std::string> problems;        // other errors

  // True if the server serves everything that was requested.
  bool ok() const { return refused.empty() && refused_labels.empty() && problems.empty(); }
};

// Notified of changes to models, on the loading thread, under no lock.
class ModelObserver {
 public:
  virtual ~ModelObserver() = default;
  // A checkpoint was loaded and is served, or was rejected. `still_served`: an earlier load of the
  // rejected checkpoint is still served.
  virtual void Loaded(const LoadReport& report, bool still_served) = 0;
  // A version is no longer served.
  virtual void Unloaded(const std::string& source) = 0;
  // A version that could not be loaded was removed from the repository.
  virtual void Forgotten(const std::string& source) = 0;
  // The repository was scanned. `skipped`: every folder that is not a checkpoint.
  virtual void Scanned(const std::vector<SkippedFolder>& skipped) = 0;
  // A reload requested by an operator has finished.
  virtual void Reloaded(const absl::StatusOr<ReloadReport>& report) = 0;
  // The served models may have changed.
  virtual void Changed() = 0;
};

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_MODEL_STATUS_H_
