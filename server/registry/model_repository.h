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
  std::string source;  // <name>/<version>, or "embedded"
  absl::StatusOr<std::shared_ptr<const engine::Synthesizer>> model;
  double load_seconds = 0;
};

struct RepositoryListing {
  std::vector<std::filesystem::path> checkpoints;  // sorted
  std::vector<absl::Status> unreadable;            // folders that could not be looked into
};

// The checkpoint folders <repository>/<name>/<version>/ that hold a manifest.json. Versions are
// numbers of 1 or more without leading zeros; other folders and files are left alone.
// Fails with NOT_FOUND or PERMISSION_DENIED when the repository itself cannot be read.
absl::StatusOr<RepositoryListing> ListCheckpoints(const std::filesystem::path& repository);

// Loads one checkpoint folder. A checkpoint whose manifest does not say the name and version that
// its folder says is refused: one of the two is wrong.
LoadReport LoadCheckpoint(const std::filesystem::path& folder, const ModelLoader& loader);

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_MODEL_REPOSITORY_H_
