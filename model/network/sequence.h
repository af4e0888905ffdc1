#ifndef DUET_MODEL_NETWORK_SEQUENCE_H_
#define DUET_MODEL_NETWORK_SEQUENCE_H_

#include <torch/torch.h>

// Clips of different lengths in one padded, time-major batch.
namespace duet::network {

// [T, N] true where a frame is valid. Shapes: lengths [N] int64.
torch::Tensor FrameMask(const torch::Tensor& lengths, int64_t frames);

// Row numbers into [T N] that turn each clip's valid frames around and leave its padding in place:
// an involution, so that it also turns results back. Shape: [T N] int64.
torch::Tensor ReversedRows(const torch::Tensor& lengths, int64_t frames);

// Row numbers of each clip's last valid frame in [T N]. Shape: [N] int64.
torch::Tensor LastRows(const torch::Tensor& lengths);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_SEQUENCE_H_
