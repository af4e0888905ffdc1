#ifndef DUET_MODEL_NETWORK_FLOW_GENERATOR_H_
#define DUET_MODEL_NETWORK_FLOW_GENERATOR_H_

#include <torch/torch.h>

#include <string>
#include <vector>

#include "absl/types/span.h"
#include "model/checkpoint/manifest.h"
#include "model/engine/network.h"
#include "model/network/parameters.h"

namespace duet::network {

// The conditions of the sampling generator for a batch of windows, in the standard coordinates.
//
// Frames of a follower may be known: its start pose, or several settled frames. The base is the
// last known frame. Without known frames it is the mean pose of the classes, weighted by their mean
// label weights over the window (with frame_labels: of all classes alike), and moved to the start
// root if that is given. The network predicts
// offsets from the base, in units of FlowArchitecture::offset_scale.
struct FlowInput {
  torch::Tensor leader;    // [N, T, 3 J] metres, zero-padded
  torch::Tensor labels;    // [N, T, C] zero-padded
  torch::Tensor lengths;   // [N] int64, valid frames of each window, 1 to T
  torch::Tensor start;     // [N, StartFeatureCount]: the root or the last known pose, what is told
  torch::Tensor base;      // [N, 3 J] metres
  torch::Tensor known;     // [N, T, 3 J] the known frames' offsets from the base; 0 elsewhere
  torch::Tensor is_known;  // [N, T, 1] 1 where a frame is known
  torch::Tensor known_count;  // [N] int64
  torch::Tensor is_hidden;    // [N, T, 1] 1 where the leader is a guess

  FlowInput To(const torch::Device& device) const;
};

// Shapes: base_poses [C, 3 J] metres, the mean pose of each class. Requires a FlowArchitecture.
FlowInput MakeFlowInput(const checkpoint::Manifest& manifest, const torch::Tensor& base_poses,
                        absl::Span<const engine::NetworkInput> inputs);

// The encoded conditions of the sampling generator. They are the same in every step.
struct FlowContext {
  torch::Tensor frames;     // [N, T, W]
  torch::Tensor condition;  // [N, W] of the start
  torch::Tensor padding;    // [N, 1, 1, T] 0, or far below where a frame is padding
};

// Selects rows of a context by index; the indices may repeat.
FlowContext Rows(const FlowContext& context, const torch::Tensor& rows);

// The sampling generator. Conditioned on a leader, a start and a class, it predicts the motion from
// a mixture (1 - t) noise + t motion (x1-prediction). It is a transformer over the window's frames
// with adaptive layer norms and a learned attention bias by distance.
//
// Source:  Lipman et al. 2023 (flow matching), Peebles, Xie 2023 (adaptive norms).
// Units:   offsets from FlowInput::base, in offset_scale metres.
// Threads: safe to call concurrently in evaluation mode.
class FlowGeneratorImpl : public NamedModule {
 public:
  // Initialises randomly; LoadParameters fills it from a checkpoint. Requires a manifest with a
  // FlowArchitecture.
  explicit FlowGeneratorImpl(const checkpoint::Manifest& manifest);

  FlowContext Prepare(const FlowInput& input) const;

  // Shapes: labels [N, C], all zeros for no class, ignored with frame_labels; sample [N, T, 3 J] at
  // times [N] in [0, 1); returns [N, T, 3 J], undefined past a window's length.
  torch::Tensor forward(const FlowContext& context, const torch::Tensor& labels,
                        const torch::Tensor& sample, const torch::Tensor& times) const;

  // Dropout probability in training mode.
  void set_dropout(double share) { dropout_ = share; }

  // Sets the tensors that are measured on the training data instead of learnt: mean followers
  // [C, 3 J] and roots of the offsets' covariances [2, 3 J, 3 J].
  void SetMeasured(const torch::Tensor& base_poses, const torch::Tensor& noise_roots);
  const torch::Tensor& base_poses() const { return base_poses_; }
  const torch::Tensor& noise_roots() const { return noise_roots_; }
  torch::Device device() const { return base_poses_.device(); }

 private:
  struct Linear {
    torch::Tensor weight;  // [outputs, inputs]
    torch::Tensor bias;    // [outputs]; undefined without
    torch::Tensor operator()(const torch::Tensor& input) const {
      return torch::nn::functional::linear(input, weight, bias);
    }
  };
  struct Block {
    Linear modulation, attention, attended, expand, contract;
    torch::Tensor distance;  // [heads, 2 reach + 1]
  };

  Linear FindLinear(const std::string& name) const;
  Block FindBlock(const std::string& name) const;
  torch::Tensor Dropped(const torch::Tensor& values) const;
  torch::Tensor Attend(const Block& block, const torch::Tensor& frames,
                       const torch::Tensor& padding) const;
  torch::Tensor Apply(const Block& block, const torch::Tensor& frames,
                      const torch::Tensor& condition, const torch::Tensor& padding) const;

  bool frame_labels_, hidden_frames_;
  Linear frames_, sample_, start_, label_, time_expand_, time_mix_, condition_, norm_, output_;
  std::vector<Block> blocks_;
  torch::Tensor base_poses_, noise_roots_;
  int64_t heads_, reach_;
  double dropout_ = 0;
};
TORCH_MODULE(FlowGenerator);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_FLOW_GENERATOR_H_
