#ifndef DUET_MODEL_ENGINE_WINDOW_PLAN_H_
#define DUET_MODEL_ENGINE_WINDOW_PLAN_H_

#include <vector>

namespace duet::engine {

// How a long clip is cut for a network that was trained on short ones: the first frame of every
// window, all of one length, overlapping and spread evenly, so that no short remainder is left at
// the end. The first starts at 0, the last ends with the clip.
struct WindowPlan {
  int length = 0;           // frames of every window
  std::vector<int> starts;  // strictly increasing
};

// How many frames neighbouring windows of `window` frames share, at least 1, where each answers for
// itself: long enough for a cross-fade that nobody sees, short enough to cost only half as much
// again.
int CrossFadeOverlap(int window);

// The same where a window goes on from frames that the one before it settled: long enough to carry
// pose, speed and the beginnings of a movement (half a second of the embedded models).
int SettledOverlap(int window);

// Fewest windows of at most `longest` frames over `frames`, neighbours sharing `overlap` or more.
// Both at least 2; `overlap` at least 1 and less than `longest`.
WindowPlan PlanWindows(int frames, int longest, int overlap);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_WINDOW_PLAN_H_
