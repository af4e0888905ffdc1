#ifndef DUET_MODEL_NETWORK_BATCH_H_
#define DUET_MODEL_NETWORK_BATCH_H_

#include <vector>

#include "absl/types/span.h"
#include "model/engine/network.h"
#include "model/network/generator.h"

namespace duet::network {

// Pads inputs of different lengths into one batch. Shapes: T is the longest one's frames.
GeneratorInput MakeInput(const checkpoint::Manifest& manifest,
                         absl::Span<const engine::NetworkInput> inputs);

// Poses of like joints, padded with zeros to `frames`: [N, frames, 3 J]. At least one.
torch::Tensor PadPoses(const std::vector<const motion::Poses*>& clips, int64_t frames);

// The first `frames` frames of one clip of a batch [N, T, 3 J].
motion::Poses TakePoses(const torch::Tensor& batch, int64_t clip, int frames);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_BATCH_H_
