#ifndef DUET_MODEL_NETWORK_KERNELS_H_
#define DUET_MODEL_NETWORK_KERNELS_H_

// The inner loops of the recurrent layers, free of LibTorch.

namespace duet::network {

// One step of LSTM cells, gates in the order i, f, g, o.
// Shapes: gates [rows, 4 H] (pre-activations in, activations out);
//         cell_before, cell, hidden [rows, H].
void LstmCellForward(int rows, int hidden_size, float* gates, const float* cell_before, float* cell,
                     float* hidden);

// Its gradient. d_cell [rows, H] holds dL/dcell in and dL/dcell_before out.
// Shapes: gates [rows, 4 H] activations; d_hidden [rows, H]; d_gates [rows, 4 H] out
// (of the pre-activations).
void LstmCellBackward(int rows, int hidden_size, const float* gates, const float* cell_before,
                      const float* cell, const float* d_hidden, float* d_cell, float* d_gates);

// Attention weights of one decoder row over the frames of its clip.
//   tanh_j = tanh(encoded_j + query), weights = softmax_j(score . tanh_j), 0 from `valid` on.
// Source: paper Eq. 2, 3.
// Shapes: encoded, tanh_out [frames, A]; query, score [A]; weights [frames].
void AttentionForward(int frames, int valid, int attention, const float* encoded,
                      const float* query, const float* score, float* tanh_out, float* weights);

// Its gradient, accumulated into d_encoded, d_score; d_query is overwritten.
// Shapes: d_weights [frames]; the others as above.
void AttentionBackward(int valid, int attention, const float* tanh_values, const float* weights,
                       const float* score, const float* d_weights, float* d_encoded, float* d_query,
                       float* d_score);

// c [m, n] = a [m, k] b + beta c, all row-major; b is [k, n], or [n, k] when transposed.
void Gemm(bool transpose_b, int m, int n, int k, const float* a, const float* b, float beta,
          float* c);

// y = x^T M (+ y when beta is 1), and y = M x. M is [rows, columns], row-major.
void VectorMatrix(int rows, int columns, const float* x, const float* matrix, float beta, float* y);
void MatrixVector(int rows, int columns, const float* matrix, const float* x, float* y);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_KERNELS_H_
