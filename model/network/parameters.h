#ifndef DUET_MODEL_NETWORK_PARAMETERS_H_
#define DUET_MODEL_NETWORK_PARAMETERS_H_

#include <torch/torch.h>

#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/checkpoint/checkpoint.h"

namespace duet::network {

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
