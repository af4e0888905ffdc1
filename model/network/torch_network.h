#ifndef DUET_MODEL_NETWORK_TORCH_NETWORK_H_
#define DUET_MODEL_NETWORK_TORCH_NETWORK_H_

#include <memory>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/engine/network.h"

namespace duet::network {

// Runs the generator of a checkpoint, of any architecture, with LibTorch on the CPU: the reference
// for the kernels of model/cpu_engine. INVALID_ARGUMENT names a tensor that is missing or has
// another shape. LibTorch's exceptions become INTERNAL.
absl::StatusOr<std::unique_ptr<const engine::Network>> MakeTorchNetwork(
    const checkpoint::Checkpoint& checkpoint);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_TORCH_NETWORK_H_
