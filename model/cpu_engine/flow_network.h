#ifndef DUET_MODEL_CPU_ENGINE_FLOW_NETWORK_H_
#define DUET_MODEL_CPU_ENGINE_FLOW_NETWORK_H_

#include <vector>

#include "absl/types/span.h"
#include "model/checkpoint/checkpoint.h"
#include "model/cpu_engine/flow_noise.h"
#include "model/cpu_engine/flow_window.h"
#include "model/cpu_engine/kernels/packed_matrix.h"
#include "model/cpu_engine/scratch.h"
#include "model/cpu_engine/weights.h"
#include "model/engine/network.h"

namespace duet::cpu_engine {

// The sampling generator. Read it from Run downwards: the conditions, the noise, the steps from
// noise to motion with the transformer in each, and the continuation of the known frames.
//
// Source:  the LibTorch version is in model/network/flow_generator.h and flow_sampler.h.
// Shapes:  T frames of a window, R frames of all windows, Q frames of all terms, J joints, W width,
//          F feed_forward.
// Threads: Run is safe to call concurrently, with one scratch per call.
class FlowNetwork {
 public:
  FlowNetwork(const checkpoint::Checkpoint& checkpoint, kernels::Precision precision);

  // As engine::Network::Run. followers[i] has the frames and joints of inputs[i].
  void Run(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch,
           absl::Span<motion::Poses> followers) const;

 private:
  struct Block {
    kernels::PackedMatrix modulation, attention, attended, expand, contract;
    std::vector<float> distance;  // [heads, 2 reach + 1]
  };
  // The values that the steps of Run share. Rows are the frames of all windows in order, or those
  // of all terms.
  struct Work {
    int windows, terms, rows, term_rows, longest;
    FlowWindow* window;  // [windows]
    FlowTerm* term;      // [terms], in the order of their windows
    int* window_row;     // [windows] first row
    int* term_row;       // [terms] first row
    float* context;      // [R, W] encoded frames
    float* told;         // [terms, W] encoded start and label
    float* sample;       // [R, 3 J] from noise to motion, in units of offset_scale
    float* answer;       // [R, 3 J]
    float* condition;    // [terms, W]
    float* time;         // [W]
    float* modulation;   // [terms, 4 W]
    float* frames;       // [Q, W] of the transformer
    float* normal;       // [Q, W]
    float* branch;       // [Q, max(3 W, F)]
    float* distance;     // [heads, 2 longest - 1]
    float* attention;    // for SelfAttention
  };

  Work Prepare(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch) const;
  void ReadWindows(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch,
                   Work* work) const;
  void ReadTerms(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch,
                 Work* work) const;
  bool Answer(const Work& work, absl::Span<const engine::NetworkInput> inputs, double time) const;
  void Condition(const Work& work, double time) const;
  void Embed(const Work& work) const;
  void Apply(const Block& block, const Work& work) const;
  void Attend(const Block& block, const Work& work) const;
  void Normalise(const Work& work, int scale) const;
  void Output(const Work& work) const;
  void Step(const Work& work, int left) const;
  void Join(const Work& work, absl::Span<motion::Poses> followers) const;

  checkpoint::Manifest manifest_;
  checkpoint::FlowArchitecture flow_;
  int width_, pose_, heads_;
  std::vector<float> base_poses_;
  FlowNoise noise_;
  kernels::PackedMatrix frames_, sample_, start_, time_expand_, time_mix_, condition_, output_;
  Layer label_;  // [W, C]
  Layer norm_;   // weight and bias [W]
  std::vector<Block> blocks_;
};

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_FLOW_NETWORK_H_
