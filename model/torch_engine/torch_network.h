#ifndef DUET_MODEL_TORCH_ENGINE_TORCH_NETWORK_H_
#define DUET_MODEL_TORCH_ENGINE_TORCH_NETWORK_H_

#include <memory>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/engine/network.h"

namespace duet::torch_engine {

// Runs the generator of a checkpoint, of any architecture, with LibTorch on the CPU.
// INVALID_ARGUMENT names a tensor that is missing or has another shape. LibTorch's exceptions
// become INTERNAL.
absl::StatusOr<std::unique_ptr<const engine::Network>> MakeTorchNetwork(
    const checkpoint::Checkpoint& checkpoint);

}  // namespace duet::torch_engine

#endif  // DUET_MODEL_TORCH_ENGINE_TORCH_NETWORK_H_
