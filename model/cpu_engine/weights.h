#ifndef DUET_MODEL_CPU_ENGINE_WEIGHTS_H_
#define DUET_MODEL_CPU_ENGINE_WEIGHTS_H_

#include <map>
#include <string>
#include <vector>

#include "model/checkpoint/checkpoint.h"
#include "model/cpu_engine/kernels/packed_matrix.h"

namespace duet::cpu_engine {

// A linear layer in the layout of a checkpoint.
struct Layer {
  std::vector<float> weight;  // [outputs, inputs]
  std::vector<float> bias;    // [outputs]; empty for none
  int outputs = 0, inputs = 0;

  kernels::PackedMatrix Pack(kernels::Precision precision) const {
    return {weight, bias, outputs, inputs, precision};
  }
};

// The composition of two layers without an activation between them: `first`, then `second`.
Layer Chained(const Layer& first, const Layer& second);
// The layer with the outputs of `above`, then those of `below`. Requires a bias in both or neither.
Layer Stacked(const Layer& above, const Layer& below);

// A checkpoint's tensors by name. The checkpoint must outlive it and contain every requested
// tensor, which ParseCheckpoint guarantees.
class Weights {
 public:
  explicit Weights(const checkpoint::Checkpoint& checkpoint);

  const std::vector<float>& Values(const std::string& name) const;
  bool Has(const std::string& name) const { return tensors_.count(name) > 0; }
  // The layer of two tensors. An empty `bias` means none.
  Layer FindLayer(const std::string& weight, const std::string& bias) const;
  // The layer of `name`.weight and `name`.bias.
  Layer FindLayer(const std::string& name) const;

 private:
  std::map<std::string, const checkpoint::Tensor*> tensors_;
};

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_WEIGHTS_H_
