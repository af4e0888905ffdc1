#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_LSTM_CELL_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_LSTM_CELL_H_

#include <cstddef>

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

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_LSTM_CELL_H_
