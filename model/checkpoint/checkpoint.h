#ifndef DUET_MODEL_CHECKPOINT_CHECKPOINT_H_
#define DUET_MODEL_CHECKPOINT_CHECKPOINT_H_

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/checkpoint/manifest.h"
#include "model/checkpoint/safetensors.h"

namespace duet::checkpoint {

// A generator as a file holds it: data only, no code.
struct Checkpoint {
  Manifest manifest;
  std::vector<Tensor> tensors;      // in the order of ExpectedTensors(manifest)
  std::vector<Tensor> critic = {};  // empty, or in the order of CriticTensors (architecture.h)
};

// Checks manifest and weights against each other: size, SHA-256, and exactly the tensors of
// ExpectedTensors, all finite, and those of CriticTensors if there is any of them.
absl::StatusOr<Checkpoint> ParseCheckpoint(std::string_view manifest_json,
                                           std::string_view weights);

// Reads <folder>/manifest.json and the weights beside it. Rejects symbolic links, names outside the
// folder and files over the maximum size. NOT_FOUND if a file is absent.
absl::StatusOr<Checkpoint> ReadCheckpoint(const std::filesystem::path& folder);

// Returns the error that WriteCheckpoint would return for this manifest, ignoring its weights and
// time. Lets a long training run fail before it starts.
absl::Status CheckManifest(Manifest manifest);

// Writes a checkpoint folder atomically (a temporary folder, then a rename).
// Sets manifest.weights, and manifest.created if it is empty. Returns the errors that
// ReadCheckpoint would return for the result. ALREADY_EXISTS if the folder exists.
absl::Status WriteCheckpoint(const std::filesystem::path& folder, Checkpoint checkpoint);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_CHECKPOINT_H_
