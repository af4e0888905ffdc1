#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_ADDITIVE_ATTENTION_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_ADDITIVE_ATTENTION_H_

#include "model/cpu_engine/kernels/gemm.h"

namespace duet::cpu_engine::kernels {

// The attention of one decoder state over the frames of its window.
struct AdditiveAttention {
  int frames;            // 1 or more
  int attention;         // A
  const float* encoded;  // [frames, A]
  const float* query;    // [A]
  const float* score;    // [A]
  float* weights;        // [frames], written
};

// weights = softmax over the frames j of score . tanh(encoded_j + query).
// Source: paper Eq. 2 and 3 (Bahdanau et al. 2015).
void WeighFrames(const AdditiveAttention& attention);

// sums += sum_j weights_j values_j over the rows of `values`. Shapes: weights [values.count], sums
// [values.width]. Source: paper Eq. 4.
void AddWeighted(const Rows& values, const float* weights, float* sums);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_ADDITIVE_ATTENTION_H_
