#ifndef DUET_MODEL_NETWORK_SEQUENCE_H_
#define DUET_MODEL_NETWORK_SEQUENCE_H_

#include <torch/torch.h>

// Clips of different lengths in one padded, time-major batch.
namespace duet::network {

// [T, N] true for valid frames. Shapes: lengths [N] int64.
torch::Tensor FrameMask(const torch::Tensor& lengths, int64_t frames);

// Row indices into [T N] that reverse each clip's valid frames and keep its padding in place. The
// permutation is its own inverse. Shape: [T N] int64.
torch::Tensor ReversedRows(const torch::Tensor& lengths, int64_t frames);

// Row indices of each clip's last valid frame in [T N]. Shape: [N] int64.
torch::Tensor LastRows(const torch::Tensor& lengths);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_SEQUENCE_H_
