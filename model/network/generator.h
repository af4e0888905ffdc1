#ifndef DUET_MODEL_NETWORK_GENERATOR_H_
#define DUET_MODEL_NETWORK_GENERATOR_H_

#include <torch/torch.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "model/checkpoint/manifest.h"

namespace duet::network {

// The parameters of the paper's generator in their computing layout: both directions in one tensor,
// forward first, and all slices in one tensor where that is faster. Sizes: E encoder units, S
// slices, A attention rows, H = S E decoder units, J joints, C classes.
//
// Biases and other vectors are flat, [2 x], so that an optimiser can distinguish them from
// matrices.
struct GeneratorParameters {
  struct Slice {
    torch::Tensor fc_weight;  // [features, input]; undefined without the layer, as fc_bias
    torch::Tensor fc_bias;    // [features]
    torch::Tensor weight_ih;  // [2, 4 E, features]
    torch::Tensor bias;       // [2 4 E]
  };
  std::vector<Slice> slices;
  torch::Tensor encoder_weight_hh;  // [2 S, 4 E, E]: every slice forward, then every slice backward

  struct Decoder {
    torch::Tensor attention_encoded;  // [2, A, 2 H]
    torch::Tensor attention_state;    // [2, A, H]
    torch::Tensor attention_score;    // [2 A]
    torch::Tensor weight_ih;          // [2, 4 H, 2 H]
    torch::Tensor weight_hh;          // [2, 4 H, H]
    torch::Tensor bias;               // [2 4 H]
  } decoder;

  torch::Tensor output_weight;  // [3 J, 2 H]
  torch::Tensor output_bias;    // [3 J]
  torch::Tensor base_weight;    // [3 J, C]; undefined without labels or base pose
  torch::Tensor base_bias;      // [3 J]; undefined without base pose
};

// The generator's input for a batch of clips, in the standard coordinates
// (model/motion/standardise.h).
struct GeneratorInput {
  torch::Tensor leader;   // [N, T, 3 J] metres, zero-padded
  torch::Tensor labels;   // [N, T, C]
  torch::Tensor start;    // [N, StartFeatureCount]; used only with follower_start
  torch::Tensor lengths;  // [N] int64, valid frames of each clip, 1 to T
};

// The paper's hierarchical generator: a fully connected layer and a bidirectional LSTM for each
// body-part slice, an attentive bidirectional decoder, and a linear output.
//
// Source:  paper sections 3.1 and 3.2. Deviations: attention over padding is masked; no softmax on
//          the output; the whole-body slice may also read the follower's start.
// Shapes:  forward returns the follower [N, T, 3 J]; frames past a clip's length are undefined.
// Units:   metres.
// Threads: forward is safe to call concurrently in evaluation mode.
class GeneratorImpl : public torch::nn::Module {
 public:
  // Initialises randomly; LoadParameters fills it from a checkpoint. Requires a manifest with a
  // PaperArchitecture.
  explicit GeneratorImpl(const checkpoint::Manifest& manifest);

  torch::Tensor forward(const GeneratorInput& input);

  // The concatenated encoder output h_t, [T, N, S 2 E]: the paper's latent space (Figures 6, 7).
  torch::Tensor Encode(const GeneratorInput& input);

  // Dropout probabilities in training mode: of the slices' features, and of the encoders' output
  // h_t and the decoder's states.
  void set_dropout(double slices, double encoded) {
    slice_dropout_ = slices;
    encoded_dropout_ = encoded;
  }

  // Sets the mean pose of each class, to which the output adds. Shapes: means [C, 3 J]. Requires
  // base_pose.
  void SetBasePoses(const torch::Tensor& means);

  // All tensors by their names in ExpectedTensors: views without gradient, to read or to fill.
  std::map<std::string, torch::Tensor> tensors() const;

 private:
  struct Encoded {
    torch::Tensor frames;  // [T, N, S 2 E]: every slice forward, then every slice backward
    torch::Tensor hidden;  // [2, N, S E] final states by direction
    torch::Tensor cell;    // [2, N, S E]
  };

  torch::Tensor SliceInput(const GeneratorInput& input, size_t slice) const;
  torch::Tensor SliceGates(const GeneratorInput& input, size_t slice,
                           const torch::Tensor& reversed) const;
  torch::Tensor Features(const GeneratorInput& input, size_t slice) const;
  Encoded EncodeAll(const GeneratorInput& input, const torch::Tensor& reversed) const;
  torch::Tensor Decode(const Encoded& encoded, const GeneratorInput& input,
                       const torch::Tensor& reversed) const;
  torch::Tensor Base(const GeneratorInput& input) const;

  std::vector<checkpoint::SliceShape> slice_shapes_;
  std::vector<torch::Tensor> columns_;  // of each part in the leader's [3 J]
  GeneratorParameters parameters_;
  bool whole_body_reads_leader_;
  bool reads_labels_;
  bool has_start_;
  bool has_base_;
  int64_t root_column_;  // of the root joint's x in [3 J]
  int64_t encoder_hidden_;
  double slice_dropout_ = 0, encoded_dropout_ = 0;
};
TORCH_MODULE(Generator);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_GENERATOR_H_
