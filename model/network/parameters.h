#ifndef DUET_MODEL_NETWORK_PARAMETERS_H_
#define DUET_MODEL_NETWORK_PARAMETERS_H_

#include <torch/torch.h>

#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/checkpoint/checkpoint.h"

namespace duet::network {

// A module whose tensors have the names of ExpectedTensors.
class NamedModule : public torch::nn::Module {
 public:
  // All tensors by name: views without gradient, to read or to fill.
  std::map<std::string, torch::Tensor> tensors() const;

 protected:
  // Registers a tensor: learnt, or a constant of the training data.
  void Add(const std::string& name, const torch::Tensor& value, bool is_learnt = true);
  // Undefined if there is none of that name.
  torch::Tensor Named(const std::string& name) const;

 private:
  std::map<std::string, torch::Tensor> by_name_;  // as registered
};

// Copies a checkpoint's tensors into `tensors`, views of those of a generator with the same
// manifest. INVALID_ARGUMENT names a tensor that is missing or has another shape.
absl::Status LoadTensors(const checkpoint::Checkpoint& checkpoint,
                         std::map<std::string, torch::Tensor> tensors);

// A generator's tensors, in the order of ExpectedTensors.
std::vector<checkpoint::Tensor> StoreTensors(const checkpoint::Manifest& manifest,
                                             const std::map<std::string, torch::Tensor>& tensors);

// The same for a generator module of any architecture.
template <typename AnyGenerator>
absl::Status LoadParameters(const checkpoint::Checkpoint& checkpoint, AnyGenerator& generator) {
  return LoadTensors(checkpoint, generator->tensors());
}
template <typename AnyGenerator>
std::vector<checkpoint::Tensor> StoreParameters(const checkpoint::Manifest& manifest,
                                                const AnyGenerator& generator) {
  return StoreTensors(manifest, generator->tensors());
}

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_PARAMETERS_H_
