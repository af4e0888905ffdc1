#ifndef DUET_MODEL_CPU_ENGINE_FLOW_WINDOW_H_
#define DUET_MODEL_CPU_ENGINE_FLOW_WINDOW_H_

#include <vector>

#include "model/checkpoint/manifest.h"
#include "model/cpu_engine/scratch.h"
#include "model/engine/network.h"

namespace duet::cpu_engine {

// What the sampling generator is told of one window, in the standard coordinates;
// model/network/flow_input.h has the same in LibTorch and explains it.
struct FlowWindow {
  int frames;        // T
  int known_frames;  // the first so many of the follower's frames are known
  float* features;   // [T, 2 x 3 J + 4 + 3 J + 1] leader, velocity, positions, known, whether known
  float* start;      // [StartFeatureCount]
  float* base;       // [3 J] metres
  const float* known(int frame, int width) const {  // [3 J] offset from the base
    return features + frame * (3 * width + 5) + 2 * width + 4;
  }
};

// Shapes: base_poses [C, 3 J] metres, the mean pose of each class; features, start and base are
// where the window's are written.
void FillFlowWindow(const checkpoint::Manifest& manifest, const std::vector<float>& base_poses,
                    const engine::NetworkInput& input, FlowWindow* window);

// One answer that is asked of the network: that for a class, or for none.
struct FlowTerm {
  int window;
  int label;      // a class, or kNoClass
  float* factor;  // [T] what the answer counts for, frame by frame
};
inline constexpr int kNoClass = -1;

// Adds a window's terms to `terms`, at most C + 1; returns how many. See
// model/network/flow_sampler.h.
int AddFlowTerms(const engine::NetworkInput& input, int window, int classes, double guidance,
                 Scratch::Use* scratch, FlowTerm* terms);

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_FLOW_WINDOW_H_
