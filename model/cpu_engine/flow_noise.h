#ifndef DUET_MODEL_CPU_ENGINE_FLOW_NOISE_H_
#define DUET_MODEL_CPU_ENGINE_FLOW_NOISE_H_

#include <cstdint>
#include <vector>

#include "model/checkpoint/architecture.h"
#include "model/cpu_engine/kernels/packed_matrix.h"
#include "model/cpu_engine/scratch.h"
#include "model/engine/synthesizer.h"

namespace duet::cpu_engine {

// The source of sampling: offsets that are smooth in time and have the joint covariance of the
// training followers. The LibTorch version is in model/network/flow_noise.h.
//
// Threads: Fill is safe to call concurrently, with one scratch per call.
class FlowNoise {
 public:
  // Shapes: roots [2, width, width] (without a start, with a start). `frames` is the length up to
  // which the factors are precomputed; longer windows are slower.
  FlowNoise(const checkpoint::FlowArchitecture::Noise& options, const std::vector<float>& roots,
            int width, int frames);

  // Writes the noise of one window, [frames, width]: it depends only on the seed, and on the index
  // of the first frame where that is set, and is multiplied by the variety. A frame does not depend
  // on the number of frames after it.
  void Fill(const engine::Sampling& sampling, int known_frames, int frames, Scratch::Use* scratch,
            float* out) const;

 private:
  // For windows with, or without, known frames.
  struct State {
    std::vector<float> over_frames;     // [frames, frames] lower-triangular
    kernels::PackedMatrix over_joints;  // [width, width]
  };

  // Independent normal numbers, and those that are smooth in time. Shapes: [frames, width] each.
  struct Drawn {
    const float* smooth;
    const float* white;
  };
  Drawn DrawWindow(uint64_t seed, bool known, int frames, Scratch::Use* scratch) const;
  // Of an endless motion. After known frames: what the last of them does not determine.
  Drawn DrawFrames(uint64_t seed, int64_t first, int known_frames, int frames,
                   Scratch::Use* scratch) const;
  // Subtracts what the last known frame says about every frame: the covariance of smooth noise at
  // their distance, exp(-(distance / length)^2 / 2), times its noise. The window continues from the
  // known frames, which contain their noise: with the whole noise, every window would add it anew,
  // and the motion would drift. Shapes: smooth [frames, width].
  void LeaveKnown(int known_frames, int frames, float* smooth) const;

  // The deviation of frame `frame`, as a fraction of the full deviation.
  float Ramp(int frame, int known_frames) const;

  checkpoint::FlowArchitecture::Noise options_;
  int width_, frames_;
  std::vector<float> smoothing_;  // of an endless motion
  State states_[2];
};

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_FLOW_NOISE_H_
