#ifndef DUET_MODEL_CPU_ENGINE_FLOW_WINDOW_H_
#define DUET_MODEL_CPU_ENGINE_FLOW_WINDOW_H_

#include <cstddef>
#include <vector>

#include "model/checkpoint/manifest.h"
#include "model/cpu_engine/scratch.h"
#include "model/engine/network.h"

namespace duet::cpu_engine {

// The conditions of the sampling generator for one window, in the standard coordinates.
// model/network/flow_generator.h explains them; it is the LibTorch version.
struct FlowWindow {
  int frames;        // T
  int known_frames;  // number of known frames at the start of the follower
  int stride;        // FrameFeatureCount
  float* features;  // [T, stride] leader, velocity, positions, known, whether known; labels; hidden
  float* start;     // [StartFeatureCount]
  float* base;      // [3 J] metres
  const float* known(int frame, int width) const {  // [3 J] offset from the base
    return features + std::ptrdiff_t{frame} * stride + std::ptrdiff_t{2} * width + 4;
  }
};

// Writes to the window's features, start and base. Shapes: base_poses [C, 3 J] metres, the mean
// pose of each class.
void FillFlowWindow(const checkpoint::Manifest& manifest, const std::vector<float>& base_poses,
                    const engine::NetworkInput& input, FlowWindow* window);

// One evaluation of the network: for a class, or for no class.
struct FlowTerm {
  int window;
  int label;      // a class, or kNoClass
  float* factor;  // [T] factor of the answer in the sum, for each frame
};
inline constexpr int kNoClass = -1;

// Writes a window's terms to `terms`, at most C + 1, and returns their number. The formula is in
// model/network/flow_sampler.h.
int AddFlowTerms(const engine::NetworkInput& input, int window, int classes,
                 const checkpoint::FlowArchitecture& flow, Scratch::Use* scratch, FlowTerm* terms);

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_FLOW_WINDOW_H_
