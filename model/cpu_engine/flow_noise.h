#ifndef DUET_MODEL_CPU_ENGINE_FLOW_NOISE_H_
#define DUET_MODEL_CPU_ENGINE_FLOW_NOISE_H_

#include <cstdint>
#include <vector>

#include "model/checkpoint/flow_architecture.h"
#include "model/cpu_engine/kernels/packed_matrix.h"
#include "model/cpu_engine/scratch.h"

namespace duet::cpu_engine {

// What sampling starts from: offsets smooth in time that covary over the joints as the training
// followers' do; model/network/flow_noise.h has the same in LibTorch.
//
// Threads: Fill is safe to call concurrently, with a scratch each.
class FlowNoise {
 public:
  // Shapes: roots [2, width, width] (no start told, start told). `frames`: of the longest window
  // that is common; longer ones take longer.
  FlowNoise(const checkpoint::FlowArchitecture::Noise& options, const std::vector<float>& roots,
            int width, int frames);

  // Writes one window's, [frames, width], drawn from `seed` alone, times `variety`. A frame does
  // not depend on how many follow.
  void Fill(uint64_t seed, float variety, int known_frames, int frames, Scratch::Use* scratch,
            float* out) const;

 private:
  // Where frames are known, or not.
  struct State {
    std::vector<float> over_frames;     // [frames, frames] lower-triangular
    kernels::PackedMatrix over_joints;  // [width, width]
  };

  // How far frame `frame` deviates, as a share of the full deviation.
  float Ramp(int frame, int known_frames) const;

  checkpoint::FlowArchitecture::Noise options_;
  int width_, frames_;
  State states_[2];
};

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_FLOW_NOISE_H_
