#ifndef DUET_SERVER_REGISTRY_MODEL_REPOSITORY_H_
#define DUET_SERVER_REGISTRY_MODEL_REPOSITORY_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::server::registry {

// Loads a model from a checkpoint folder. The main program chooses the engine.
using ModelLoader = std::function<absl::StatusOr<std::shared_ptr<const engine::Synthesizer>>(
    const std::filesystem::path& folder)>;

// The result of loading one checkpoint.
struct LoadReport {
  std::string source;  // <name>/<version>, or "embedded/<name>/<version>"
  absl::StatusOr<std::shared_ptr<const engine::Synthesizer>> model;
  double load_seconds = 0;
};

// A folder in the repository that is not a checkpoint.
struct SkippedFolder {
  std::string folder;  // <name>, or <name>/<version>
  std::string reason;
  friend bool operator==(const SkippedFolder& a, const SkippedFolder& b) {
    return a.folder == b.folder && a.reason == b.reason;
  }
};

struct RepositoryListing {
  std::vector<std::filesystem::path> checkpoints;  // sorted
  std::vector<SkippedFolder> skipped;              // sorted
};

// Lists the checkpoint folders <repository>/<name>/<version>/ that contain a manifest.json.
// Versions are numbers of at least 1 without leading zeros. Other folders are reported as skipped,
// with a reason. Files and names that start with a dot are ignored.
//
// Any folder may be a symbolic link. A version may be a volume mounted by Kubernetes, whose content
// is behind its link `..data`.
//
// Returns NOT_FOUND or PERMISSION_DENIED if the repository itself cannot be read.
absl::StatusOr<RepositoryListing> ListCheckpoints(const std::filesystem::path& repository);

// Returns the current folder of a checkpoint's files, with symbolic links and `..data` resolved.
// All files read from it belong to the same checkpoint, even if the links change in the meantime.
std::filesystem::path ResolveCheckpoint(const std::filesystem::path& folder);

// Describes a checkpoint's files as the file system does: name, device, inode, size and times of
// each. An equal text means equal content. Hidden files and documents (*.md), which no engine
// reads, do not count. Empty if there are no files.
std::string FilesOf(const std::filesystem::path& folder);

// Loads one checkpoint folder and checks its results (CheckAnswers). Rejects a checkpoint if name
// or version in its manifest differ from those of its folder.
LoadReport LoadCheckpoint(const std::filesystem::path& folder, const ModelLoader& loader);

// How models are loaded.
struct ModelSource {
  std::string engine;  // for the log and replies (SynthesisHeader): "cpu, int16, AVX-512"
  ModelLoader load_folder;
  // Loads the embedded models. The default model is the first.
  std::function<absl::StatusOr<std::vector<std::shared_ptr<const engine::Synthesizer>>>()>
      load_embedded;
};

// Maximum distance of a follower from its leader, metres. In captured pairs it is at most 3.
inline constexpr float kFarthestFollower = 8;

// Returns a synthetic leader for any skeleton: it stands on the floor at the origin, sways, and
// swings its limbs. Shapes: [frames, joints]. Units: metres, y up.
motion::Poses GoldenLeader(const motion::Skeleton& skeleton, int frames, double frame_rate_hz);

// Checks that a newly loaded model returns plausible results, and warms it up. Evaluates one window
// of a fixed leader without a class and with each class, without clean-up. Returns INVALID_ARGUMENT
// if a joint is not finite or farther from the leader's root than kFarthestFollower, which
// indicates corrupt weights; or the model's own error.
absl::Status CheckAnswers(const engine::Synthesizer& model);

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
  virtual void Unloaded(const std::string& /*source*/) {}
  // A version that could not be loaded was removed from the repository.
  virtual void Forgotten(const std::string& /*source*/) {}
  // The repository was scanned. `skipped`: every folder that is not a checkpoint.
  virtual void Scanned(const std::vector<SkippedFolder>& /*skipped*/) {}
  // A reload requested by an operator has finished.
  virtual void Reloaded(const absl::StatusOr<ReloadReport>& /*report*/) {}
  // The served models may have changed.
  virtual void Changed() {}
};

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_MODEL_REPOSITORY_H_
