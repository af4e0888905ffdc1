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

// Loads one checkpoint folder and checks its results (golden_check.h). Rejects a checkpoint if name
// or version in its manifest differ from those of its folder.
LoadReport LoadCheckpoint(const std::filesystem::path& folder, const ModelLoader& loader);

// How models are loaded.
struct ModelSource {
  std::string engine;  // for the log and replies (SynthesisHeader): "cpu, bf16, AVX-512"
  ModelLoader load_folder;
  // Loads the embedded models. The default model is the first.
  std::function<absl::StatusOr<std::vector<std::shared_ptr<const engine::Synthesizer>>>()>
      load_embedded;
};

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_MODEL_REPOSITORY_H_
