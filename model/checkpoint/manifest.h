#ifndef DUET_MODEL_CHECKPOINT_MANIFEST_H_
#define DUET_MODEL_CHECKPOINT_MANIFEST_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/architecture.h"
#include "model/checkpoint/safetensors.h"
#include "model/engine/model_description.h"
#include "model/motion/body_part.h"
#include "model/motion/standardise.h"

namespace duet::checkpoint {

// The version of the checkpoint format that this code writes. It also reads older versions, and
// rejects newer ones.
inline constexpr int kCheckpointFormatVersion = 2;

// Maximum sizes of manifest.json and of the weights file.
inline constexpr std::size_t kMaxManifestBytes = std::size_t{1} << 20;
inline constexpr std::size_t kMaxWeightsBytes = std::size_t{512} << 20;

// The weights' file beside the manifest, and what its content must be.
struct WeightsFile {
  std::string file = "weights.safetensors";
  uint64_t bytes = 0;
  std::string sha256;  // lower-case hex
};

// manifest.json of a checkpoint folder <name>/<version>/.
struct Manifest {
  int format_version = kCheckpointFormatVersion;
  engine::ModelDescription model;
  // Body parts of the skeleton, in the order of the slices of the paper's generator.
  std::vector<motion::BodyPart> parts;
  Architecture architecture;
  // The network's coordinates (model/engine/windows.h): metres, y up, one yaw for
  // the window. The origin is the leader's root: in every frame, as in the paper, or in the first
  // frame of the window.
  motion::StandardOrigin standardisation = motion::StandardOrigin::kEveryFrame;
  WeightsFile weights;
  std::string git_revision;
  std::string created;                          // RFC 3339; WriteCheckpoint fills in an empty one
  std::map<std::string, std::string> training;  // settings and data of the run; informative
  std::map<std::string, double> metrics;        // "afd.kick": 0.61, ...
};

// Turns `text` into the name of a model: each character that a name must not contain becomes '_'.
std::string ToPlainName(std::string_view text);

// Reads and writes manifest.json (docs/checkpoint_format.md). `text` may be untrusted: unknown,
// missing, repeated or mistyped fields, sizes out of range and inconsistent skeletons are
// INVALID_ARGUMENT; the message names the field, its value and the range. Sets the derived fields
// of `model`: weights_sha256, and those of SetArchitecture.
absl::StatusOr<Manifest> ParseManifest(std::string_view text);
// Requires a skeleton and parts that Validate accepts.
std::string SerializeManifest(const Manifest& manifest);

// Number of values that describe a follower start: root (3), pose relative to the root (3 x
// joints), and two flags (root known, pose known).
int StartFeatureCount(const motion::Skeleton& skeleton);

// Names and shapes of the tensors of a checkpoint, in their order. They depend only on the
// manifest; the tables are beside Tensors() of each architecture.
std::vector<TensorSpec> ExpectedTensors(const Manifest& manifest);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_MANIFEST_H_
