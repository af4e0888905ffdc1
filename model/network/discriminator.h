#ifndef DUET_MODEL_NETWORK_DISCRIMINATOR_H_
#define DUET_MODEL_NETWORK_DISCRIMINATOR_H_

#include <torch/torch.h>

#include <vector>

namespace duet::network {

struct DiscriminatorOptions {
  int64_t input = 45;  // values a frame
  int64_t window_frames = 46;
  int64_t hidden = 200;  // LSTM units of each direction
  int64_t outputs = 7;   // interaction classes, and one more for "synthesised"
};

// The class-aware discriminator: two bidirectional LSTM layers over the follower's motion, then a
// fully connected layer on the outputs of all time steps. With one output per class it is also the
// classifier of the paper's Table 6 and of the FID's features.
//
// Source:  paper section 3.3 and MSHL22 (without the binary one).
// Shapes:  motion [N, T, input], T <= window_frames; lengths [N] int64;
//          returns logits [N, outputs].
// Padding: masked before the fully connected layer.
class DiscriminatorImpl : public torch::nn::Module {
 public:
  explicit DiscriminatorImpl(const DiscriminatorOptions& options);

  torch::Tensor forward(const torch::Tensor& motion, const torch::Tensor& lengths);

  // The second layer's output averaged over the valid frames, [N, 2 hidden].
  torch::Tensor Features(const torch::Tensor& motion, const torch::Tensor& lengths);

  void set_dropout(double probability) { dropout_ = probability; }

  // Scales every row of the input kernels to length 1, as the released code constrains them.
  void NormaliseKernels();

 private:
  struct Layer {
    torch::Tensor weight_ih, weight_hh, bias;  // [2, 4 H, in], [2, 4 H, H], [2, 4 H]
  };

  Layer MakeLayer(const std::string& name, int64_t input);
  // [T, N, in] -> [T, N, 2 H], padding zeroed.
  torch::Tensor Run(const Layer& layer, const torch::Tensor& input,
                    const torch::Tensor& lengths) const;
  torch::Tensor RunBoth(const torch::Tensor& motion, const torch::Tensor& lengths) const;

  DiscriminatorOptions options_;
  std::vector<Layer> layers_;
  torch::nn::Linear output_{nullptr};
  double dropout_ = 0;
};
TORCH_MODULE(Discriminator);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_DISCRIMINATOR_H_
