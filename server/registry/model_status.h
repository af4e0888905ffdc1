#ifndef DUET_SERVER_REGISTRY_MODEL_STATUS_H_
#define DUET_SERVER_REGISTRY_MODEL_STATUS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/registry/model_repository.h"

namespace duet::server::registry {

// How it stands with a version that was ever looked at.
enum class ModelState {
  kLoading,   // for the first time; while its successor loads, a version is served
  kServed,    // answers calls
  kFailed,    // could not be loaded
  kUnloaded,  // is in the repository, but policy or operator do not want it
};

struct ModelStatus {
  std::string name;
  uint32_t version = 0;
  ModelState state = ModelState::kUnloaded;
  bool is_default = false;
  std::vector<std::string> version_labels;  // sorted
  // Why its last load failed; empty if it succeeded. If the version is served nevertheless, what
  // answers calls was loaded before, and `outdated` is true.
  std::string error;
  bool outdated = false;
  double load_seconds = 0;  // of what is served
};

// What a reload did. Each version as "<name>/<version>".
struct ReloadReport {
  std::vector<std::string> loaded;    // new, or in place of what was served
  std::vector<std::string> refused;   // ModelStatus tells why
  std::vector<std::string> unloaded;  // no longer in the repository, or no longer wanted
  int unchanged = 0;
  std::vector<std::string> refused_labels;  // whose versions are not served
  std::vector<std::string> problems;        // what else could not be done as it should

  // Whether everything that was asked for is so now.
  bool ok() const { return refused.empty() && refused_labels.empty() && problems.empty(); }
};

// Hears what becomes of models. Called by whoever loads, under no lock.
class ModelObserver {
 public:
  virtual ~ModelObserver() = default;
  // A checkpoint is served from now on, or was refused; `still_served` tells of a refused one that
  // what was loaded before in its place goes on.
  virtual void Loaded(const LoadReport& report, bool still_served) = 0;
  // A version is served no longer.
  virtual void Unloaded(const std::string& source) = 0;
  // A version that could not be loaded is no longer there, or no longer wanted.
  virtual void Forgotten(const std::string& source) = 0;
  // The repository was looked through; each folder that is no checkpoint, new or not.
  virtual void Scanned(const std::vector<SkippedFolder>& skipped) = 0;
  // A reload that an operator asked for is over.
  virtual void Reloaded(const absl::StatusOr<ReloadReport>& report) = 0;
  // What is served may be other than it was.
  virtual void Changed() = 0;
};

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_MODEL_STATUS_H_
