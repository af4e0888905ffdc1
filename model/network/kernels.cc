#include "model/network/kernels.h"

#include <cblas.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

// Compiles a function once for each level of the x86-64 instruction set; the loader picks.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define DUET_CPU_CLONES \
  __attribute__((target_clones("arch=skylake-avx512", "arch=haswell", "default")))
#else
#define DUET_CPU_CLONES
#endif
// A function that the clones share must be inlined into each clone to be compiled for its level.
#define DUET_INLINE inline __attribute__((always_inline))

namespace duet::network {
namespace {

// e^x for a loop that the compiler vectorises: Cody-Waite reduction and a degree 6 polynomial.
// Relative error below 2e-7 over the clamped range.
DUET_INLINE float Exp(float x) {
  constexpr float kLog2E = 1.44269504088896341f;
  constexpr float kLn2High = 0.693359375f, kLn2Low = -2.12194440e-4f;
  constexpr float kRound = 12582912.0f;  // 1.5 * 2^23: adding it rounds to the nearest integer
  x = x < -87.0f ? -87.0f : x;
  x = x > 88.0f ? 88.0f : x;
  const float shifted = x * kLog2E + kRound;
  const float n = shifted - kRound;
  const float r = x - n * kLn2High - n * kLn2Low;
  float p = 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  p = p * r * r + r + 1.0f;
  const int32_t exponent = static_cast<int32_t>(n) * (1 << 23);
  int32_t bits;
  std::memcpy(&bits, &p, sizeof(bits));
  bits += exponent;
  std::memcpy(&p, &bits, sizeof(p));
  return p;
}
DUET_INLINE double Exp(double x) { return std::exp(x); }

template <typename S>
DUET_INLINE S Sigmoid(S x) {
  return S(1) / (S(1) + Exp(-x));
}

template <typename S>
DUET_INLINE S Tanh(S x) {
  return S(1) - S(2) / (Exp(S(2) * x) + S(1));
}

template <typename S>
DUET_INLINE void CellForward(int rows, int hidden_size, S* gates, const S* cell_before, S* cell,
                             S* hidden) {
  const int h = hidden_size;
  for (int row = 0; row < rows; ++row) {
    S* __restrict i = gates + static_cast<ptrdiff_t>(row) * 4 * h;
    S* __restrict f = i + h;
    S* __restrict g = f + h;
    S* __restrict o = g + h;
    const S* __restrict before = cell_before + static_cast<ptrdiff_t>(row) * h;
    S* __restrict after = cell + static_cast<ptrdiff_t>(row) * h;
    S* __restrict out = hidden + static_cast<ptrdiff_t>(row) * h;
    for (int u = 0; u < h; ++u) {
      i[u] = Sigmoid(i[u]);
      f[u] = Sigmoid(f[u]);
      g[u] = Tanh(g[u]);
      o[u] = Sigmoid(o[u]);
      after[u] = f[u] * before[u] + i[u] * g[u];
      out[u] = o[u] * Tanh(after[u]);
    }
  }
}

template <typename S>
DUET_INLINE void CellBackward(int rows, int hidden_size, const S* gates, const S* cell_before,
                              const S* cell, const S* d_hidden, S* d_cell, S* d_gates) {
  const int h = hidden_size;
  for (int row = 0; row < rows; ++row) {
    const S* __restrict i = gates + static_cast<ptrdiff_t>(row) * 4 * h;
    const S *f = i + h, *g = f + h, *o = g + h;
    const S* __restrict before = cell_before + static_cast<ptrdiff_t>(row) * h;
    const S* __restrict after = cell + static_cast<ptrdiff_t>(row) * h;
    const S* __restrict dh = d_hidden + static_cast<ptrdiff_t>(row) * h;
    S* __restrict dc = d_cell + static_cast<ptrdiff_t>(row) * h;
    S* __restrict di = d_gates + static_cast<ptrdiff_t>(row) * 4 * h;
    S* __restrict df = di + h;
    S* __restrict dg = df + h;
    S* __restrict d_o = dg + h;
    for (int u = 0; u < h; ++u) {
      const S t = Tanh(after[u]);
      const S d = dc[u] + dh[u] * o[u] * (S(1) - t * t);
      d_o[u] = dh[u] * t * o[u] * (S(1) - o[u]);
      di[u] = d * g[u] * i[u] * (S(1) - i[u]);
      df[u] = d * before[u] * f[u] * (S(1) - f[u]);
      dg[u] = d * i[u] * (S(1) - g[u] * g[u]);
      dc[u] = d * f[u];
    }
  }
}

template <typename S>
DUET_INLINE void Attend(int frames, int valid, int attention, const S* encoded, const S* query,
                        const S* score, S* tanh_out, S* weights) {
  S largest = S(-1e30);
  for (int j = 0; j < valid; ++j) {
    const S* __restrict in = encoded + static_cast<ptrdiff_t>(j) * attention;
    S* __restrict out = tanh_out + static_cast<ptrdiff_t>(j) * attention;
    // A fixed number of partial sums, so that the order of additions, and the result, does not
    // depend on the compiler's vector width.
    constexpr int kLanes = 16;
    S sums[kLanes] = {};
    int a = 0;
    for (; a + kLanes <= attention; a += kLanes) {
      for (int lane = 0; lane < kLanes; ++lane) {
        out[a + lane] = Tanh(in[a + lane] + query[a + lane]);
        sums[lane] += score[a + lane] * out[a + lane];
      }
    }
    S sum = 0;
    for (; a < attention; ++a) {
      out[a] = Tanh(in[a] + query[a]);
      sum += score[a] * out[a];
    }
    for (int lane = 0; lane < kLanes; ++lane) sum += sums[lane];
    weights[j] = sum;
    largest = std::max(largest, sum);
  }
  S total = 0;
  for (int j = 0; j < valid; ++j) {
    weights[j] = Exp(weights[j] - largest);
    total += weights[j];
  }
  for (int j = 0; j < valid; ++j) weights[j] /= total;
  for (int j = valid; j < frames; ++j) weights[j] = 0;
}

template <typename S>
DUET_INLINE void AttendBackward(int valid, int attention, const S* tanh_values, const S* weights,
                                const S* score, const S* d_weights, S* d_encoded, S* d_query,
                                S* d_score) {
  std::fill_n(d_query, attention, S(0));
  S mean = 0;
  for (int j = 0; j < valid; ++j) mean += weights[j] * d_weights[j];
  for (int j = 0; j < valid; ++j) {
    const S d_energy = weights[j] * (d_weights[j] - mean);
    const S* __restrict t = tanh_values + static_cast<ptrdiff_t>(j) * attention;
    S* __restrict d = d_encoded + static_cast<ptrdiff_t>(j) * attention;
    for (int a = 0; a < attention; ++a) {
      const S through = d_energy * score[a] * (S(1) - t[a] * t[a]);
      d[a] += through;
      d_query[a] += through;
      d_score[a] += d_energy * t[a];
    }
  }
}

}  // namespace

DUET_CPU_CLONES void LstmCellForward(int rows, int hidden_size, float* gates,
                                     const float* cell_before, float* cell, float* hidden) {
  CellForward(rows, hidden_size, gates, cell_before, cell, hidden);
}
void LstmCellForward(int rows, int hidden_size, double* gates, const double* cell_before,
                     double* cell, double* hidden) {
  CellForward(rows, hidden_size, gates, cell_before, cell, hidden);
}

DUET_CPU_CLONES void LstmCellBackward(int rows, int hidden_size, const float* gates,
                                      const float* cell_before, const float* cell,
                                      const float* d_hidden, float* d_cell, float* d_gates) {
  CellBackward(rows, hidden_size, gates, cell_before, cell, d_hidden, d_cell, d_gates);
}
void LstmCellBackward(int rows, int hidden_size, const double* gates, const double* cell_before,
                      const double* cell, const double* d_hidden, double* d_cell, double* d_gates) {
  CellBackward(rows, hidden_size, gates, cell_before, cell, d_hidden, d_cell, d_gates);
}

DUET_CPU_CLONES void AttentionForward(int frames, int valid, int attention, const float* encoded,
                                      const float* query, const float* score, float* tanh_out,
                                      float* weights) {
  Attend(frames, valid, attention, encoded, query, score, tanh_out, weights);
}
void AttentionForward(int frames, int valid, int attention, const double* encoded,
                      const double* query, const double* score, double* tanh_out, double* weights) {
  Attend(frames, valid, attention, encoded, query, score, tanh_out, weights);
}

DUET_CPU_CLONES void AttentionBackward(int valid, int attention, const float* tanh_values,
                                       const float* weights, const float* score,
                                       const float* d_weights, float* d_encoded, float* d_query,
                                       float* d_score) {
  AttendBackward(valid, attention, tanh_values, weights, score, d_weights, d_encoded, d_query,
                 d_score);
}
void AttentionBackward(int valid, int attention, const double* tanh_values, const double* weights,
                       const double* score, const double* d_weights, double* d_encoded,
                       double* d_query, double* d_score) {
  AttendBackward(valid, attention, tanh_values, weights, score, d_weights, d_encoded, d_query,
                 d_score);
}

void Gemm(bool transpose_b, int m, int n, int k, const float* a, const float* b, float beta,
          float* c) {
  cblas_sgemm(CblasRowMajor, CblasNoTrans, transpose_b ? CblasTrans : CblasNoTrans, m, n, k, 1, a,
              k, b, transpose_b ? k : n, beta, c, n);
}
void Gemm(bool transpose_b, int m, int n, int k, const double* a, const double* b, double beta,
          double* c) {
  cblas_dgemm(CblasRowMajor, CblasNoTrans, transpose_b ? CblasTrans : CblasNoTrans, m, n, k, 1, a,
              k, b, transpose_b ? k : n, beta, c, n);
}

void VectorMatrix(int rows, int columns, const float* x, const float* matrix, float beta,
                  float* y) {
  cblas_sgemv(CblasRowMajor, CblasTrans, rows, columns, 1, matrix, columns, x, 1, beta, y, 1);
}
void VectorMatrix(int rows, int columns, const double* x, const double* matrix, double beta,
                  double* y) {
  cblas_dgemv(CblasRowMajor, CblasTrans, rows, columns, 1, matrix, columns, x, 1, beta, y, 1);
}

void MatrixVector(int rows, int columns, const float* matrix, const float* x, float* y) {
  cblas_sgemv(CblasRowMajor, CblasNoTrans, rows, columns, 1, matrix, columns, x, 1, 0, y, 1);
}
void MatrixVector(int rows, int columns, const double* matrix, const double* x, double* y) {
  cblas_dgemv(CblasRowMajor, CblasNoTrans, rows, columns, 1, matrix, columns, x, 1, 0, y, 1);
}

}  // namespace duet::network
