#ifndef DUET_MODEL_NETWORK_LSTM_H_
#define DUET_MODEL_NETWORK_LSTM_H_

#include <ATen/core/Tensor.h>

#include <utility>

namespace duet::network {

// Runs G independent LSTMs of equal size side by side, differentiably.
//
// The input's part of the gates, x W_ih^T + b, is computed by the caller for the whole sequence at
// once; the loop over time holds only what depends on the step before.
//
// Shapes:  gates [T, G, N, 4 H] (order i, f, g, o); weight_hh [G, 4 H, H]; hidden, cell [G, N, H];
//          returns the hidden and cell states after every step, each [T, G, N, H].
// Padding: steps past a clip's end compute values that the caller ignores; they cannot reach
//          earlier ones.
// Threads: safe to call concurrently.
std::pair<at::Tensor, at::Tensor> LstmSequence(const at::Tensor& gates, const at::Tensor& weight_hh,
                                               const at::Tensor& hidden, const at::Tensor& cell);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_LSTM_H_
