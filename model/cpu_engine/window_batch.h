#ifndef DUET_MODEL_CPU_ENGINE_WINDOW_BATCH_H_
#define DUET_MODEL_CPU_ENGINE_WINDOW_BATCH_H_

#include "absl/types/span.h"
#include "model/cpu_engine/scratch.h"
#include "model/engine/network.h"

namespace duet::cpu_engine {

// Which values of which window are where: the frames of all windows, longest window first, each
// window's one after the other, are the rows of one matrix. No frame is padding.
struct WindowBatch {
  int count;             // windows
  int rows;              // frames of all of them
  const int* input;      // [count] which of the inputs it is
  const int* length;     // [count] frames, falling
  const int* first_row;  // [count]

  // `most` of the windows from `begin` on, or as many as there are. Their rows stay where they are.
  WindowBatch Some(int begin, int most) const {
    const int size = begin + most < count ? most : count - begin;
    const int last = begin + size - 1;
    return {size, first_row[last] + length[last] - first_row[begin], input + begin, length + begin,
            first_row + begin};
  }

  // Windows that have a frame `step`: the first so many. `before` is the answer for an earlier
  // step.
  int LongerThan(int step, int before) const {
    while (before > 0 && length[before - 1] <= step) --before;
    return before;
  }
};

WindowBatch MakeWindowBatch(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch);

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_WINDOW_BATCH_H_
