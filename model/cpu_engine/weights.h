#ifndef DUET_MODEL_CPU_ENGINE_WEIGHTS_H_
#define DUET_MODEL_CPU_ENGINE_WEIGHTS_H_

#include <map>
#include <string>
#include <vector>

#include "model/checkpoint/checkpoint.h"
#include "model/cpu_engine/kernels/packed_matrix.h"

namespace duet::cpu_engine {

// A linear layer as a checkpoint has it.
struct Layer {
  std::vector<float> weight;  // [outputs, inputs]
  std::vector<float> bias;    // [outputs]; empty for none
  int outputs = 0, inputs = 0;

  kernels::PackedMatrix Pack(kernels::Precision precision) const {
    return {weight, bias, outputs, inputs, precision};
  }
};

// The layer that does what `first` and then `second` do: nothing lies between them.
Layer Chained(const Layer& first, const Layer& second);
// The layer whose outputs are those of `above`, then those of `below`. Both have a bias, or none.
Layer Stacked(const Layer& above, const Layer& below);

// A checkpoint's tensors by name. The checkpoint outlives it, and has every tensor that is asked
// for (ParseCheckpoint saw to that).
class Weights {
 public:
  explicit Weights(const checkpoint::Checkpoint& checkpoint);

  const std::vector<float>& Values(const std::string& name) const;
  bool Has(const std::string& name) const { return tensors_.count(name) > 0; }
  // A matrix by its whole name, and a bias by its own or none.
  Layer FindLayer(const std::string& weight, const std::string& bias) const;
  // `name`.weight with `name`.bias.
  Layer FindLayer(const std::string& name) const;

 private:
  std::map<std::string, const checkpoint::Tensor*> tensors_;
};

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_WEIGHTS_H_
