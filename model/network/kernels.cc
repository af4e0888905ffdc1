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

DUET_INLINE float Sigmoid(float x) { return 1 / (1 + Exp(-x)); }

DUET_INLINE float Tanh(float x) { return 1 - 2 / (Exp(2 * x) + 1); }

}  // namespace

DUET_CPU_CLONES void LstmCellForward(int rows, int hidden_size, float* gates,
                                     const float* cell_before, float* cell, float* hidden) {
  const int h = hidden_size;
  for (int row = 0; row < rows; ++row) {
    float* __restrict i = gates + static_cast<ptrdiff_t>(row) * 4 * h;
    float* __restrict f = i + h;
    float* __restrict g = f + h;
    float* __restrict o = g + h;
    const float* __restrict before = cell_before + static_cast<ptrdiff_t>(row) * h;
    float* __restrict after = cell + static_cast<ptrdiff_t>(row) * h;
    float* __restrict out = hidden + static_cast<ptrdiff_t>(row) * h;
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

DUET_CPU_CLONES void LstmCellBackward(int rows, int hidden_size, const float* gates,
                                      const float* cell_before, const float* cell,
                                      const float* d_hidden, float* d_cell, float* d_gates) {
  const int h = hidden_size;
  for (int row = 0; row < rows; ++row) {
    const float* __restrict i = gates + static_cast<ptrdiff_t>(row) * 4 * h;
    const float *f = i + h, *g = f + h, *o = g + h;
    const float* __restrict before = cell_before + static_cast<ptrdiff_t>(row) * h;
    const float* __restrict after = cell + static_cast<ptrdiff_t>(row) * h;
    const float* __restrict dh = d_hidden + static_cast<ptrdiff_t>(row) * h;
    float* __restrict dc = d_cell + static_cast<ptrdiff_t>(row) * h;
    float* __restrict di = d_gates + static_cast<ptrdiff_t>(row) * 4 * h;
    float* __restrict df = di + h;
    float* __restrict dg = df + h;
    float* __restrict d_o = dg + h;
    for (int u = 0; u < h; ++u) {
      const float t = Tanh(after[u]);
      const float d = dc[u] + dh[u] * o[u] * (1 - t * t);
      d_o[u] = dh[u] * t * o[u] * (1 - o[u]);
      di[u] = d * g[u] * i[u] * (1 - i[u]);
      df[u] = d * before[u] * f[u] * (1 - f[u]);
      dg[u] = d * i[u] * (1 - g[u] * g[u]);
      dc[u] = d * f[u];
    }
  }
}

DUET_CPU_CLONES void AttentionForward(int frames, int valid, int attention, const float* encoded,
                                      const float* query, const float* score, float* tanh_out,
                                      float* weights) {
  float largest = -1e30f;
  for (int j = 0; j < valid; ++j) {
    const float* __restrict in = encoded + static_cast<ptrdiff_t>(j) * attention;
    float* __restrict out = tanh_out + static_cast<ptrdiff_t>(j) * attention;
    // A fixed number of partial sums, so that the order of additions, and the result, does not
    // depend on the compiler's vector width.
    constexpr int kLanes = 16;
    float sums[kLanes] = {};
    int a = 0;
    for (; a + kLanes <= attention; a += kLanes) {
      for (int lane = 0; lane < kLanes; ++lane) {
        out[a + lane] = Tanh(in[a + lane] + query[a + lane]);
        sums[lane] += score[a + lane] * out[a + lane];
      }
    }
    float sum = 0;
    for (; a < attention; ++a) {
      out[a] = Tanh(in[a] + query[a]);
      sum += score[a] * out[a];
    }
    for (int lane = 0; lane < kLanes; ++lane) sum += sums[lane];
    weights[j] = sum;
    largest = std::max(largest, sum);
  }
  float total = 0;
  for (int j = 0; j < valid; ++j) {
    weights[j] = Exp(weights[j] - largest);
    total += weights[j];
  }
  for (int j = 0; j < valid; ++j) weights[j] /= total;
  for (int j = valid; j < frames; ++j) weights[j] = 0;
}

DUET_CPU_CLONES void AttentionBackward(int valid, int attention, const float* tanh_values,
                                       const float* weights, const float* score,
                                       const float* d_weights, float* d_encoded, float* d_query,
                                       float* d_score) {
  std::fill_n(d_query, attention, 0.0f);
  float mean = 0;
  for (int j = 0; j < valid; ++j) mean += weights[j] * d_weights[j];
  for (int j = 0; j < valid; ++j) {
    const float d_energy = weights[j] * (d_weights[j] - mean);
    const float* __restrict t = tanh_values + static_cast<ptrdiff_t>(j) * attention;
    float* __restrict d = d_encoded + static_cast<ptrdiff_t>(j) * attention;
    for (int a = 0; a < attention; ++a) {
      const float through = d_energy * score[a] * (1 - t[a] * t[a]);
      d[a] += through;
      d_query[a] += through;
      d_score[a] += d_energy * t[a];
    }
  }
}

void Gemm(bool transpose_b, int m, int n, int k, const float* a, const float* b, float beta,
          float* c) {
  cblas_sgemm(CblasRowMajor, CblasNoTrans, transpose_b ? CblasTrans : CblasNoTrans, m, n, k, 1, a,
              k, b, transpose_b ? k : n, beta, c, n);
}

void VectorMatrix(int rows, int columns, const float* x, const float* matrix, float beta,
                  float* y) {
  cblas_sgemv(CblasRowMajor, CblasTrans, rows, columns, 1, matrix, columns, x, 1, beta, y, 1);
}

void MatrixVector(int rows, int columns, const float* matrix, const float* x, float* y) {
  cblas_sgemv(CblasRowMajor, CblasNoTrans, rows, columns, 1, matrix, columns, x, 1, 0, y, 1);
}

}  // namespace duet::network
