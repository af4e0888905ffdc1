#ifndef DUET_MODEL_ENGINE_WINDOW_PLAN_H_
#define DUET_MODEL_ENGINE_WINDOW_PLAN_H_

#include <vector>

namespace duet::engine {

// How a long clip is cut into overlapping windows for a network that was trained on short ones. All
// windows have the same length and are spread evenly, so that no short remainder is left at the
// end. The first starts at 0, the last ends with the clip.
struct WindowPlan {
  int length = 0;           // frames of every window
  std::vector<int> starts;  // strictly increasing
};

// Returns the number of frames, at least 1, that neighbouring windows of `window` frames share if
// each window is independent: long enough for an invisible cross-fade, short enough to add only
// half of the cost.
int CrossFadeOverlap(int window);

// Returns the same if a window continues from frames that the previous one settled: long enough to
// carry pose, speed and the start of a movement (half a second for the embedded models).
int SettledOverlap(int window);

// Plans the fewest windows of at most `longest` frames that cover `frames`, neighbours sharing at
// least `overlap` frames. Requires `frames` and `longest` >= 2, and 1 <= `overlap` < `longest`.
WindowPlan PlanWindows(int frames, int longest, int overlap);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_WINDOW_PLAN_H_
