#ifndef DUET_MODEL_CPU_ENGINE_WINDOW_BATCH_H_
#define DUET_MODEL_CPU_ENGINE_WINDOW_BATCH_H_

#include "absl/types/span.h"
#include "model/cpu_engine/scratch.h"
#include "model/engine/network.h"

namespace duet::cpu_engine {

// The layout of a batch: the rows of one matrix are the frames of all windows, window by window,
// the longest window first. There is no padding.
struct WindowBatch {
  int count;             // windows
  int rows;              // frames of all of them
  const int* input;      // [count] index of the input
  const int* length;     // [count] frames, in descending order
  const int* first_row;  // [count]

  // At most `most` windows from `begin` on. Their rows keep their indices.
  WindowBatch Some(int begin, int most) const {
    const int size = begin + most < count ? most : count - begin;
    const int last = begin + size - 1;
    return {size, first_row[last] + length[last] - first_row[begin], input + begin, length + begin,
            first_row + begin};
  }

  // Number of windows that have a frame `step`; they are the first ones. `before` is the result for
  // an earlier step.
  int LongerThan(int step, int before) const {
    while (before > 0 && length[before - 1] <= step) --before;
    return before;
  }
};

WindowBatch MakeWindowBatch(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch);

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_WINDOW_BATCH_H_
