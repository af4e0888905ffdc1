#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_RECURRENT_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_RECURRENT_H_

#include <cstddef>

// The kernels of the paper's generator.
namespace duet::cpu_engine::kernels {

// One step of `count` LSTM cells of `hidden` units. Gates in the order i f g o.
struct LstmStep {
  int count;
  int hidden;
  const float* gates;           // [count, 4 hidden], rows gates_stride apart; null for zeros
  std::ptrdiff_t gates_stride;  // values
  const float* const* inputs;   // [count] rows of [4 hidden] to add to the gates; null for none
  float* state;                 // [count, hidden] h, rows state_stride apart; written
  float* cell;                  // [count, hidden] c, rows state_stride apart; read and written
  std::ptrdiff_t state_stride;  // values
  float* const* outputs;        // [count] rows of [hidden]: copies of h, written
};

// Source: Hochreiter, Schmidhuber 1997, with forget gates, like LibTorch's LSTM.
void LstmCells(const LstmStep& step);

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

// sums += sum_j weights_j values_j. Shapes: values [frames, width], weights [frames], sums [width].
// Source: paper Eq. 4.
void AddWeighted(int frames, int width, const float* values, const float* weights, float* sums);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_RECURRENT_H_
