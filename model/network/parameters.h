#ifndef DUET_MODEL_NETWORK_PARAMETERS_H_
#define DUET_MODEL_NETWORK_PARAMETERS_H_

#include "absl/status/status.h"
#include "model/checkpoint/checkpoint.h"
#include "model/network/generator.h"

namespace duet::network {

// Copies a checkpoint's tensors into a generator made from the same manifest. INVALID_ARGUMENT
// names a tensor that is missing or of another shape.
absl::Status LoadParameters(const checkpoint::Checkpoint& checkpoint, Generator& generator);

// A generator's parameters, in the order of ExpectedTensors.
std::vector<checkpoint::Tensor> StoreParameters(const checkpoint::Manifest& manifest,
                                                const Generator& generator);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_PARAMETERS_H_
