#ifndef DUET_MODEL_ENGINE_WINDOW_PLAN_H_
#define DUET_MODEL_ENGINE_WINDOW_PLAN_H_

#include <vector>

namespace duet::engine {

// How a long clip is cut for a network that was trained on short ones: the first frame of every
// window, all of one length, overlapping by about a third or more and spread evenly, so that no
// short remainder is left at the end. The first starts at 0, the last ends with the clip.
struct WindowPlan {
  int length = 0;           // frames of every window
  std::vector<int> starts;  // strictly increasing
};

// Fewest windows of at most `longest` frames over `frames`. Both at least 2.
WindowPlan PlanWindows(int frames, int longest);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_WINDOW_PLAN_H_
