#ifndef DUET_MODEL_NETWORK_BATCH_H_
#define DUET_MODEL_NETWORK_BATCH_H_

#include <vector>

#include "absl/types/span.h"
#include "model/engine/network.h"
#include "model/network/generator.h"

namespace duet::network {

// Pads inputs of different lengths into one batch. Shapes: T is the number of frames of the
// longest.
GeneratorInput MakeInput(const checkpoint::Manifest& manifest,
                         absl::Span<const engine::NetworkInput> inputs);

// Pads poses with the same joints with zeros to `frames`: returns [N, frames, 3 J]. Requires at
// least one clip.
torch::Tensor PadPoses(const std::vector<const motion::Poses*>& clips, int64_t frames);

// The first `frames` frames of one clip of a batch [N, T, 3 J].
motion::Poses TakePoses(const torch::Tensor& batch, int64_t clip, int frames);

// Each input's own frames of a batch of answers [N, T, 3 J].
std::vector<motion::Poses> TakeAll(const torch::Tensor& batch,
                                   absl::Span<const engine::NetworkInput> inputs);

// Appends the rows of a tensor [N, M] to `out`.
void AppendRows(const torch::Tensor& rows, std::vector<std::vector<float>>* out);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_BATCH_H_
