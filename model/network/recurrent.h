#ifndef DUET_MODEL_NETWORK_RECURRENT_H_
#define DUET_MODEL_NETWORK_RECURRENT_H_

#include <torch/torch.h>

#include <utility>

// The recurrent layers of the paper's networks, and the rows of clips of different lengths in one
// padded, time-major batch.
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

// [T, N] true for valid frames. Shapes: lengths [N] int64.
torch::Tensor FrameMask(const torch::Tensor& lengths, int64_t frames);

// Row indices into [T N] that reverse each clip's valid frames and keep its padding in place. The
// permutation is its own inverse. Shape: [T N] int64.
torch::Tensor ReversedRows(const torch::Tensor& lengths, int64_t frames);

// Row indices of each clip's last valid frame in [T N]. Shape: [N] int64.
torch::Tensor LastRows(const torch::Tensor& lengths);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_RECURRENT_H_
