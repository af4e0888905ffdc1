#ifndef DUET_MODEL_NETWORK_ACTIVATIONS_H_
#define DUET_MODEL_NETWORK_ACTIVATIONS_H_

#include <cmath>
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

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_ACTIVATIONS_H_
