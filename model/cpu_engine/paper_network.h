#ifndef DUET_MODEL_CPU_ENGINE_PAPER_NETWORK_H_
#define DUET_MODEL_CPU_ENGINE_PAPER_NETWORK_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "model/checkpoint/checkpoint.h"
#include "model/cpu_engine/kernels/packed_matrix.h"
#include "model/cpu_engine/scratch.h"
#include "model/cpu_engine/weights.h"
#include "model/cpu_engine/window_batch.h"
#include "model/engine/network.h"

namespace duet::cpu_engine {

// The paper's hierarchical generator, to be read from top to bottom of Run: the slices' features
// and encoders, the attentive decoder in both directions, the output, the base pose.
//
// Source:  paper sections 3.1 and 3.2; model/network/generator.h has the same in LibTorch, and says
//          where it deviates.
// Shapes:  T frames of a window, R of all windows, J joints, C classes, S slices, E encoder units
// of
//          a slice and direction, H = S E decoder units of a direction, A rows of the attention.
// Threads: Run is safe to call concurrently, with a scratch each.
class PaperNetwork {
 public:
  PaperNetwork(const checkpoint::Checkpoint& checkpoint, kernels::Precision precision);

  // As engine::Network::Run. followers[i] has the frames and joints of inputs[i].
  void Run(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch,
           absl::Span<motion::Poses> followers) const;

 private:
  // What a part of the body, or the whole, is read with.
  struct Slice {
    std::vector<int> columns;     // of a row of the input
    kernels::PackedMatrix input;  // fully connected layer and W_ih as one: [2 x 4 E, columns]
    kernels::PackedMatrix recurrent[2];  // W_hh of each direction, [4 E, E]
  };
  // One direction of the decoder.
  struct Direction {
    kernels::PackedMatrix encoded;  // U, [A, 2 H]
    kernels::PackedMatrix values;   // W_ih with the bias, [4 H, 2 H]
    kernels::PackedMatrix state;    // W_hh above V, [4 H + A, H]
    std::vector<float> score;       // [A]
  };
  // What passes between the steps of Run.
  struct Work {
    absl::Span<const engine::NetworkInput> inputs;
    WindowBatch batch;
    const float* input;  // [R, inputs_]
    float* encoded;      // [R, 2 H]: every slice forward, then every slice backward
    float* hidden[2];    // [windows, H] of each direction: the encoders' last, then the decoder's
    float* cell[2];
    float* states;  // [R, 2 H] of the decoder, forward and backward
  };

  // What a direction of the decoder needs for some windows.
  struct DecoderWork {
    float* encoded;                // [rows, A] U h
    float* values;                 // [rows, 4 H]
    uint16_t* packed;              // the values for products in bfloat16; null in float32
    std::ptrdiff_t packed_window;  // values from one window to the next
    float* gates;                  // [windows, 4 H + A], the query behind the gates
    float* weights;                // [T] of the window at hand
    float** outputs;               // [windows]
  };

  Slice FindSlice(const checkpoint::Manifest& manifest, const Weights& weights, int index) const;
  float* ReadInput(const WindowBatch& batch, absl::Span<const engine::NetworkInput> inputs,
                   Scratch::Use* scratch) const;
  void Encode(const Work& work, Scratch::Use* scratch) const;
  void EncodeSlice(const Work& work, int slice, int direction, const float* gates,
                   Scratch::Use* scratch) const;
  DecoderWork PrepareDecoder(const WindowBatch& batch, Scratch::Use* scratch) const;
  void Decode(const Work& work, const WindowBatch& batch, int direction, std::ptrdiff_t hidden,
              const DecoderWork& decoder) const;
  void LookAt(const WindowBatch& batch, int n, int direction, const DecoderWork& decoder,
              float* gates) const;
  void AddBase(const Work& work, float* followers) const;

  int joints_, classes_, root_, encoder_, state_, attention_;
  bool has_start_, has_base_;
  int inputs_;  // values of a row: leader [3 J], labels [C], start [3 + 3 J + 2]
  std::vector<Slice> slices_;
  Direction directions_[2];
  kernels::PackedMatrix output_;  // [3 J, 2 H]
  Layer base_;                    // [3 J, C]; without weights in an unlabelled generator
  kernels::Precision precision_;
};

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_PAPER_NETWORK_H_
