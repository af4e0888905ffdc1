#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_ADDITIVE_ATTENTION_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_ADDITIVE_ATTENTION_H_

namespace duet::cpu_engine::kernels {

// What one decoder state looks at.
struct AdditiveAttention {
  int frames;            // 1 or more
  int attention;         // A
  int width;             // X
  const float* encoded;  // [frames, A]
  const float* values;   // [frames, X]
  const float* query;    // [A]
  const float* score;    // [A]
  float* weights;        // [frames], written
  float* sums;           // [X], added to
};

// weights = softmax over the frames j of score . tanh(encoded_j + query);
// sums += sum_j weights_j values_j.
// Source: paper Eq. 2 to 4 (Bahdanau et al. 2015).
void Attend(const AdditiveAttention& attention);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_ADDITIVE_ATTENTION_H_
