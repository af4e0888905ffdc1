#ifndef DUET_MODEL_NETWORK_ATTENTIVE_DECODER_H_
#define DUET_MODEL_NETWORK_ATTENTIVE_DECODER_H_

#include <ATen/core/Tensor.h>

namespace duet::network {

// The inputs of both directions of the attentive decoder, stacked along G = 2.
struct DecoderInputs {
  at::Tensor encoded;    // [G, N, T, A]    U h_j of every frame
  at::Tensor values;     // [G, N, T, 4 H]  W_ih h_j + b of every frame
  at::Tensor weight_hh;  // [G, 4 H, H]
  at::Tensor state;      // [G, A, H]       V
  at::Tensor score;      // [G, A]          w1
  at::Tensor hidden;     // [G, N, H]       initial
  at::Tensor cell;       // [G, N, H]
  at::Tensor lengths;    // [N] int64, valid frames of each clip, 1 to T
};

// Runs the attentive LSTM for T steps, differentiably; returns the hidden state after each,
// [T, G, N, H].
//
// At step t, with s the state before it: e_j = w1 . tanh(U h_j + V s), phi = softmax over the
// valid frames, c_t = sum_j phi_j h_j, then an LSTM cell on c_t.
//
// Source: paper section 3.2, Eq. 2 and 3. Deviation: padding is masked. W_ih c_t + b is computed as
// sum_j phi_j (W_ih h_j + b), which is equal because the weights sum to 1. The product with W_ih
// is then computed once, outside the loop over time.
// Threads: safe to call concurrently.
at::Tensor AttentiveDecoder(const DecoderInputs& inputs);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_ATTENTIVE_DECODER_H_
