#ifndef DUET_MODEL_CHECKPOINT_CHECKPOINT_H_
#define DUET_MODEL_CHECKPOINT_CHECKPOINT_H_

#include <filesystem>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/checkpoint/manifest.h"
#include "model/checkpoint/safetensors.h"

namespace duet::checkpoint {

// A generator at rest: data only, never code.
struct Checkpoint {
  Manifest manifest;
  std::vector<Tensor> tensors;  // in the order of ExpectedTensors(manifest)
};

// Checks manifest and weights against each other: size, SHA-256, and exactly the tensors of
// ExpectedTensors, all finite.
absl::StatusOr<Checkpoint> ParseCheckpoint(std::string_view manifest_json,
                                           std::string_view weights);

// Reads <folder>/manifest.json and the weights beside it. Refuses symbolic links, names that leave
// the folder, files over the size cap. NOT_FOUND when a file is absent.
absl::StatusOr<Checkpoint> ReadCheckpoint(const std::filesystem::path& folder);

// Whether WriteCheckpoint would take a manifest, its weights and time aside: to know before a long
// training rather than after it.
absl::Status CheckManifest(Manifest manifest);

// Writes a checkpoint folder, model card included, whole or not at all (a temporary folder, then a
// rename); fills in manifest.weights and an empty manifest.created. Refuses what ReadCheckpoint
// would refuse, with its message. ALREADY_EXISTS when the folder exists.
absl::Status WriteCheckpoint(const std::filesystem::path& folder, Checkpoint checkpoint);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_CHECKPOINT_H_
