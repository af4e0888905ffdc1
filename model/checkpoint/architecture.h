#ifndef DUET_MODEL_CHECKPOINT_ARCHITECTURE_H_
#define DUET_MODEL_CHECKPOINT_ARCHITECTURE_H_

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "model/checkpoint/safetensors.h"
#include "model/engine/critic.h"
#include "model/engine/model_description.h"

namespace duet::checkpoint {

struct Checkpoint;
struct Manifest;

// The input of the whole-body slice, which follows the slices of the body parts.
enum class GeneratorVariant {
  kPaper,      // the whole body with the label vector
  kReleased,   // only the label vector
  kUnlabelled  // only the whole body (MSHL22, and the ablation of the embedding)
};

// The paper's hierarchical generator (sections 3.1 and 3.2). Its slices are Manifest::parts and the
// whole body. Every size comes from a manifest or a training configuration; none has a default.
struct PaperArchitecture {
  static constexpr std::string_view kKind = "paper";
  static constexpr bool kSamples = false;
  bool AcceptsFollowerStart() const { return follower_start; }
  static bool LabelsGuide() { return false; }

  GeneratorVariant variant = GeneratorVariant::kPaper;
  // The whole-body slice also gets the follower's start (see StartFeatureCount).
  bool follower_start = false;
  // A slice's fully connected layer has its input's width + this many outputs; 0: no such layer.
  int slice_features = 0;
  // LSTM units of each slice in each direction. The decoder has slices x this in each direction.
  int encoder_hidden = 0;
  // Rows of W2 in the attention score (Eq. 2).
  int attention = 0;
  // The output layer adds to a base: the follower's start if given, else a mean pose that is linear
  // in the label vector (in an unlabelled generator, the same for all classes).
  bool base_pose = false;
};

// The tensors, with E = encoder_hidden, S = slices, A = attention, J = joints, C = classes:
//   encoder.<slice>.fc.weight        [features, input]     (absent if slice_features is 0)
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
//   base.weight                      [3 J, C]              (base_pose, except unlabelled)
//   base.bias                        [3 J]                 (base_pose)
std::vector<TensorSpec> Tensors(const Manifest& manifest, const PaperArchitecture& paper);

// Slices of the generator: the parts, then the whole body. Requires a manifest of this
// architecture.
struct SliceShape {
  std::string name;  // part name, or "whole_body"
  int input = 0;     // values per frame
  int features = 0;  // after the fully connected layer
};
std::vector<SliceShape> SliceShapes(const Manifest& manifest);

// The sampling generator: a transformer over the whole window, trained by conditional flow
// matching. Every value comes from a manifest or a training configuration; none has a default.
struct FlowArchitecture {
  static constexpr std::string_view kKind = "flow";
  static constexpr bool kSamples = true;
  static bool AcceptsFollowerStart() { return true; }
  bool LabelsGuide() const { return !frame_labels; }

  int width = 0;
  int blocks = 0;
  int heads = 0;  // divides the width
  int feed_forward = 0;
  int reach = 0;  // frames; attention distinguishes distances up to this one

  // Labels are an input of every frame, so that the answer follows labels that change within a
  // window, and one evaluation of the network serves any mixture. Otherwise the network is
  // evaluated for each class, and the answers are combined by the label weights of each frame.
  bool frame_labels = false;

  // Whether the network reads which of the leader's frames are a guess
  // (NetworkInput::hidden_frames). It then serves live sessions and clips alike.
  bool hidden_frames = false;

  // One unit of the network's output, metres. The output is an offset from a base pose.
  double offset_scale = 0;

  // The source distribution of sampling: offsets like those of the training followers, smooth in
  // time.
  struct Noise {
    double frame_length = 0;    // of the squared exponential kernel over the frames
    double constant_share = 0;  // of the variance, constant over a clip; only without a start pose
    int ramp_frames = 0;        // after the last known frame until the full deviation
    double white = 0;           // standard deviation of the independent part of each frame
  } noise;

  int steps = 0;        // Euler steps from noise to motion
  double guidance = 0;  // factor of the label weights above 0
  int fade_frames = 0;  // over which the correction at the last known frame fades out
};

// Sines and cosines that encode the time of the flow, from 0 (noise) to 1 (motion).
inline constexpr int kTimeFeatures = 32;
// Distances of a frame from the window's ends, and the window's length.
inline constexpr int kPositionFeatures = 4;

// Values of each frame that the layer "frames" reads.
int64_t FrameFeatureCount(const Manifest& manifest, const FlowArchitecture& flow);

// The tensors, with W = width, F = feed_forward, J = joints, C = classes, L = FrameFeatureCount:
//   frames.weight                    [W, L]                leader, its velocity, 4 positions, known
//   frames.bias                      [W]                   frames' offsets, known or not; with
//                                                          frame_labels, C label weights; with
//                                                          hidden_frames, whether hidden
//   sample.weight                    [W, 3 J]
//   start.weight, .bias              [W, StartFeatureCount], [W]
//   label.weight                     [W, C]                absent with frame_labels
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
//   noise.roots                      [2, 3 J, 3 J]         roots of the offsets' covariances:
//                                                          without a start, with a start
std::vector<TensorSpec> Tensors(const Manifest& manifest, const FlowArchitecture& flow);

// Every architecture of a generator: its sizes, and what its files contain. An alternative T has
//   T::kKind       its name in "generator.kind" of manifests and training configurations
//   T::kSamples    whether answers depend on a seed
//   AcceptsFollowerStart()
//   LabelsGuide()           // ModelDescription::labels_guide
//   Tensors(manifest, T), declared beside T
//   Declare(Fields*, T*) in architecture.cc
// All that dispatches on the variant in this layer is architecture.cc. The layers above register
// each alternative in one place each; docs/guides/add_a_model_architecture.md lists them.
using Architecture = std::variant<PaperArchitecture, FlowArchitecture>;

// Sets the architecture, and in manifest->model what follows from it: `samples` and
// `accepts_follower_start`.
void SetArchitecture(const Architecture& architecture, Manifest* manifest);

// The critic's tensors have names that begin with this.
inline constexpr std::string_view kCriticPrefix = "critic.";

// The tensors of a critic, with U = 16 units and I = 9 joints + classes:
//   critic.frames.weight, .bias   [U, I], [U]
//   critic.near.weight, .bias     [U, U, 3], [U]
//   critic.far.weight, .bias      [U, U, 3], [U]
//   critic.output.weight, .bias   [1, U], [1]
std::vector<TensorSpec> CriticTensors(const engine::ModelDescription& model);

// The checkpoint's critic, if it has one. Requires tensors that ParseCheckpoint accepts.
std::optional<engine::Critic> CriticOf(const Checkpoint& checkpoint);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_ARCHITECTURE_H_
