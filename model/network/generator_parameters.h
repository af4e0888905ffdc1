#ifndef DUET_MODEL_NETWORK_GENERATOR_PARAMETERS_H_
#define DUET_MODEL_NETWORK_GENERATOR_PARAMETERS_H_

#include <torch/torch.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "model/checkpoint/manifest.h"

namespace duet::network {

// The generator's parameters in the form that it computes with: both directions, forward first, and
// where it pays all slices, in one tensor. Sizes as in ExpectedTensors: E encoder units, S slices,
// A attention rows, H = S E decoder units, J joints, C classes.
//
// Biases and other vectors are flat, [2 x], so that an optimiser tells them from matrices.
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

// Randomly initialised, from LibTorch's generator of random numbers.
GeneratorParameters MakeParameters(const checkpoint::Manifest& manifest);

// Every tensor of ExpectedTensors by its name there: views into the parameters, without gradient.
std::map<std::string, torch::Tensor> ViewsByName(const GeneratorParameters& parameters,
                                                 const std::vector<checkpoint::SliceShape>& slices);

// The defined ones as a module registers them, with a name each and to be replaced by what it
// registers.
std::vector<std::pair<std::string, torch::Tensor*>> Registered(GeneratorParameters* parameters);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_GENERATOR_PARAMETERS_H_
