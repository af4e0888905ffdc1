#include "model/network/sequence.h"

namespace duet::network {

torch::Tensor FrameMask(const torch::Tensor& lengths, int64_t frames) {
  return torch::arange(frames, lengths.options()).unsqueeze(1) < lengths.unsqueeze(0);
}

torch::Tensor ReversedRows(const torch::Tensor& lengths, int64_t frames) {
  const torch::Tensor frame = torch::arange(frames).unsqueeze(1);
  const torch::Tensor turned = lengths.unsqueeze(0) - 1 - frame;
  const torch::Tensor from = torch::where(turned >= 0, turned, frame.expand_as(turned));
  return (from * lengths.size(0) + torch::arange(lengths.size(0)).unsqueeze(0)).flatten();
}

torch::Tensor LastRows(const torch::Tensor& lengths) {
  return (lengths - 1) * lengths.size(0) + torch::arange(lengths.size(0));
}

}  // namespace duet::network
