#ifndef DUET_MODEL_NETWORK_GENERATOR_PARAMETERS_H_
#define DUET_MODEL_NETWORK_GENERATOR_PARAMETERS_H_

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

// Initialises randomly, with LibTorch's random number generator.
GeneratorParameters MakeParameters(const checkpoint::Manifest& manifest);

// All tensors by their names in ExpectedTensors: views into the parameters, without gradient.
std::map<std::string, torch::Tensor> ViewsByName(const GeneratorParameters& parameters,
                                                 const std::vector<checkpoint::SliceShape>& slices);

// The defined tensors with the names that a module registers them by. The module replaces each by
// the registered tensor.
std::vector<std::pair<std::string, torch::Tensor*>> Registered(GeneratorParameters* parameters);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_GENERATOR_PARAMETERS_H_
