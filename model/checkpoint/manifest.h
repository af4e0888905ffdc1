#ifndef DUET_MODEL_CHECKPOINT_MANIFEST_H_
#define DUET_MODEL_CHECKPOINT_MANIFEST_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/flow_architecture.h"
#include "model/engine/model_description.h"
#include "model/motion/body_part.h"
#include "model/motion/standardise.h"

namespace duet::checkpoint {

// The version of the checkpoint format that this code writes. Older ones are read, newer refused.
inline constexpr int kCheckpointFormatVersion = 2;

// The largest manifest.json and the largest weights file that are read.
inline constexpr std::size_t kMaxManifestBytes = std::size_t{1} << 20;
inline constexpr std::size_t kMaxWeightsBytes = std::size_t{512} << 20;

// What the whole-body slice, after those of the parts, reads.
enum class GeneratorVariant {
  kPaper,      // the whole body with the label vector
  kReleased,   // the label vector alone
  kUnlabelled  // the whole body alone (MSHL22, and the ablation of the embedding)
};

// Sizes of the generator (paper section 3.1, 3.2). All else follows from skeleton and classes.
struct GeneratorArchitecture {
  // What the encoder reads as one each. In the file they stand with the skeleton.
  std::vector<motion::BodyPart> parts;
  GeneratorVariant variant = GeneratorVariant::kPaper;
  // The whole-body slice also gets the follower's start (see StartFeatureCount).
  bool follower_start = false;
  // A slice's fully connected layer has its width + this many outputs; 0 leaves the layer out.
  int slice_features = 50;
  // LSTM units of each slice in each direction. The decoder has slices x this in each direction.
  int encoder_hidden = 40;
  // Rows of W2 in the attention score (Eq. 2).
  int attention = 128;
  // The output layer adds to a base: the follower's start where it is given, else a mean pose that
  // is linear in the label vector (the same for all classes in an unlabelled generator).
  bool base_pose = false;
};

// Where the weights are and what they must hash to.
struct WeightsFile {
  std::string file = "weights.safetensors";
  uint64_t bytes = 0;
  std::string sha256;  // lower-case hex
};

// manifest.json of a checkpoint folder <name>/<version>/.
struct Manifest {
  int format_version = kCheckpointFormatVersion;
  engine::ModelDescription model;
  GeneratorArchitecture generator;
  // The sampling generator in place of the paper's, of which the parts alone are read then.
  std::optional<FlowArchitecture> flow;
  // The coordinates that the network works in (model/engine/window_standardisation.h): metres, y
  // up, one yaw for the window. The origin is the leader's root: in every frame, as in the paper,
  // or in the window's first.
  motion::StandardOrigin standardisation = motion::StandardOrigin::kEveryFrame;
  WeightsFile weights;
  std::string git_revision;
  std::string created;                          // RFC 3339; WriteCheckpoint fills in an empty one
  std::map<std::string, std::string> training;  // settings and data of the run, for people
  std::map<std::string, double> metrics;        // "afd.kick": 0.61, ...
};

// `text` as the name of a model: what a name may not hold becomes '_'.
std::string ToPlainName(std::string_view text);

// Reads and writes manifest.json. Strict: unknown, missing, repeated or mistyped fields, sizes out
// of range and inconsistent skeletons are INVALID_ARGUMENT, naming the field, what came and what
// was wanted. `text` may come from anywhere. model.accepts_follower_start is taken from
// generator.follower_start; a sampling generator always accepts one. model.weights_sha256 is taken
// from weights. Fields: docs/checkpoint_format.md.
absl::StatusOr<Manifest> ParseManifest(std::string_view text);
// Requires a skeleton and parts that Validate accepts.
std::string SerializeManifest(const Manifest& manifest);

// Slices of the generator: the parts, then the whole body.
struct SliceShape {
  std::string name;  // part name, or "whole_body"
  int input = 0;     // values a frame
  int features = 0;  // after the fully connected layer
};
std::vector<SliceShape> SliceShapes(const Manifest& manifest);

// Values that describe a follower start: root (3), pose relative to the root (3 x joints), and two
// flags (root known, pose known).
int StartFeatureCount(const motion::Skeleton& skeleton);

// A tensor that a checkpoint must hold, float32.
struct TensorSpec {
  std::string name;
  std::vector<int64_t> shape;
};

// The one table of tensor names and shapes, fixed by the manifest:
//   encoder.<slice>.fc.weight        [features, input]     (absent when slice_features is 0)
//   encoder.<slice>.fc.bias          [features]
//   encoder.<slice>.<dir>.weight_ih  [4 E, features]       dir: forward, backward; gates i f g o
//   encoder.<slice>.<dir>.weight_hh  [4 E, E]
//   encoder.<slice>.<dir>.bias       [4 E]
//   decoder.<dir>.attention_encoded  [A, S 2 E]            U of W2 = [U V]
//   decoder.<dir>.attention_state    [A, S E]              V
//   decoder.<dir>.attention_score    [A]                   w1
//   decoder.<dir>.weight_ih          [4 S E, S 2 E]
//   decoder.<dir>.weight_hh          [4 S E, S E]
//   decoder.<dir>.bias               [4 S E]
//   output.weight                    [3 J, S 2 E]
//   output.bias                      [3 J]
//   base.weight                      [3 J, C]              (base_pose, labels only)
//   base.bias                        [3 J]                 (base_pose only)
// with E = encoder_hidden, S = slices, A = attention, J = joints, C = classes. A sampling
// generator's:
//   frames.weight                    [W, 9 J + 5]          leader, its velocity, 4 positions, known
//   frames.bias                      [W]                   frames' offsets, known or not
//   sample.weight                    [W, 3 J]
//   start.weight, .bias              [W, StartFeatureCount], [W]
//   label.weight                     [W, C]
//   time.expand.weight, .bias        [W, 32], [W]
//   time.mix, condition              [W, W], [W]           .weight, .bias, as all below
//   block<i>.modulation              [4 W, W], [4 W]       shift, scale; of attention, feed-forward
//   block<i>.attention               [3 W, W], [3 W]       queries, keys, values
//   block<i>.attended                [W, W], [W]
//   block<i>.distance                [heads, 2 reach + 1]  (no .weight)
//   block<i>.expand                  [F, W], [F]
//   block<i>.contract                [W, F], [W]
//   norm                             [W], [W]
//   output                           [3 J, W], [3 J]
//   base.poses                       [C, 3 J]              mean followers, metres
//   noise.roots                      [2, 3 J, 3 J]         roots of the offsets' covariances: no
//                                                          start told, start told
// with W = width, F = feed_forward.
std::vector<TensorSpec> ExpectedTensors(const Manifest& manifest);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_MANIFEST_H_
