#include "model/cpu_engine/window_batch.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace duet::cpu_engine {

WindowBatch MakeWindowBatch(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch) {
  const int count = static_cast<int>(inputs.size());
  const auto frames = [&](int n) {
    return inputs[static_cast<std::size_t>(n)].leader.frame_count();
  };
  int* order = scratch->Take<int>(count);
  std::iota(order, order + count, 0);
  // Not stable_sort, which allocates.
  std::sort(order, order + count,
            [&](int a, int b) { return frames(a) != frames(b) ? frames(a) > frames(b) : a < b; });
  int* length = scratch->Take<int>(count);
  int* first_row = scratch->Take<int>(count);
  int rows = 0;
  for (int n = 0; n < count; ++n) {
    length[n] = frames(order[n]);
    first_row[n] = rows;
    rows += length[n];
  }
  return {count, rows, order, length, first_row};
}

}  // namespace duet::cpu_engine
