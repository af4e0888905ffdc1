#ifndef DUET_MODEL_NETWORK_LSTM_H_
#define DUET_MODEL_NETWORK_LSTM_H_

#include <ATen/core/Tensor.h>

#include <utility>

namespace duet::network {

// Runs G independent LSTMs of equal size side by side, differentiably.
//
// The caller computes the input's part of the gates, x W_ih^T + b, for the whole sequence at once.
// The loop over time contains only what depends on the previous step.
//
// Shapes:  gates [T, G, N, 4 H] (order i, f, g, o); weight_hh [G, 4 H, H]; hidden, cell [G, N, H];
//          returns the hidden and cell states after every step, each [T, G, N, H].
// Padding: steps past a clip's end compute values that the caller ignores; they do not affect
//          earlier steps.
// Threads: safe to call concurrently.
std::pair<at::Tensor, at::Tensor> LstmSequence(const at::Tensor& gates, const at::Tensor& weight_hh,
                                               const at::Tensor& hidden, const at::Tensor& cell);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_LSTM_H_
