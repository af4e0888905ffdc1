#include "model/engine/window_plan.h"

#include <algorithm>
#include <cstdint>

namespace duet::engine {

int CrossFadeOverlap(int window) { return std::max(1, window / 3); }

int SettledOverlap(int window) { return std::max(1, (window + 3) / 6); }

WindowPlan PlanWindows(int frames, int longest, int overlap) {
  if (frames <= longest) return {frames, {0}};
  const int step = longest - overlap;
  const int64_t last_start = frames - longest;
  const int64_t steps = (last_start + step - 1) / step;  // windows after the first
  WindowPlan plan{longest, {}};
  for (int64_t k = 0; k <= steps; ++k) {
    // Rounded to the nearest frame; never more than `step` apart, since step is whole.
    plan.starts.push_back(static_cast<int>((2 * k * last_start + steps) / (2 * steps)));
  }
  return plan;
}

}  // namespace duet::engine
