#ifndef DUET_MODEL_CHECKPOINT_PAPER_ARCHITECTURE_H_
#define DUET_MODEL_CHECKPOINT_PAPER_ARCHITECTURE_H_

#include <string>
#include <string_view>
#include <vector>

#include "model/checkpoint/safetensors.h"

namespace duet::checkpoint {

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
  static constexpr std::string_view kSummary = "one answer for each request (the paper's)";
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

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_PAPER_ARCHITECTURE_H_
