#ifndef DUET_MODEL_NETWORK_GENERATOR_H_
#define DUET_MODEL_NETWORK_GENERATOR_H_

#include <torch/torch.h>

#include <string>
#include <vector>

#include "model/checkpoint/manifest.h"
#include "model/network/parameters.h"

namespace duet::network {

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
class GeneratorImpl : public NamedModule {
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

 private:
  struct Encoded {
    torch::Tensor frames;  // [T, N, S 2 E]: every slice forward, then every slice backward
    torch::Tensor hidden;  // [2, N, S E] final states by direction
    torch::Tensor cell;    // [2, N, S E]
  };

  // A tensor of the decoder in both directions, forward first: [2, ...].
  torch::Tensor BothDirections(const std::string& name) const;
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
