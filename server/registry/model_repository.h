#ifndef DUET_SERVER_REGISTRY_MODEL_REPOSITORY_H_
#define DUET_SERVER_REGISTRY_MODEL_REPOSITORY_H_

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/engine/synthesizer.h"

namespace duet::server::registry {

// Turns a checkpoint folder into a model. Only the main program knows which engine it is.
using ModelLoader = std::function<absl::StatusOr<std::shared_ptr<const engine::Synthesizer>>(
    const std::filesystem::path& folder)>;

// What became of one checkpoint.
struct LoadReport {
  std::string source;  // <name>/<version>, or "embedded/<name>/<version>"
  absl::StatusOr<std::shared_ptr<const engine::Synthesizer>> model;
  double load_seconds = 0;
};

// A folder that is no checkpoint although it lies where one is looked for.
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

// The checkpoint folders <repository>/<name>/<version>/ that hold a manifest.json. Versions are
// numbers of 1 or more without leading zeros; every other folder is skipped for a reason. Files,
// and whatever begins with a dot, are nobody's business.
//
// Any of the folders may be a symbolic link, and a version may be a volume as Kubernetes mounts
// them, whose content lies behind its link `..data`.
//
// Fails with NOT_FOUND or PERMISSION_DENIED when the repository itself cannot be read.
absl::StatusOr<RepositoryListing> ListCheckpoints(const std::filesystem::path& repository);

// Where a checkpoint's files are at this moment, symbolic links and `..data` followed: all files
// read from there are of one kind, even if the links change meanwhile.
std::filesystem::path ResolveCheckpoint(const std::filesystem::path& folder);

// Loads one checkpoint folder and checks its answers (golden_check.h). A checkpoint whose manifest
// does not say the name and version that its folder says is refused: one of the two is wrong.
LoadReport LoadCheckpoint(const std::filesystem::path& folder, const ModelLoader& loader);

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_MODEL_REPOSITORY_H_
