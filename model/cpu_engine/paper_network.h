#ifndef DUET_MODEL_CPU_ENGINE_PAPER_NETWORK_H_
#define DUET_MODEL_CPU_ENGINE_PAPER_NETWORK_H_

#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "model/checkpoint/checkpoint.h"
#include "model/cpu_engine/kernels/packed_matrix.h"
#include "model/cpu_engine/scratch.h"
#include "model/cpu_engine/weights.h"
#include "model/engine/network.h"

namespace duet::cpu_engine {

// The layout of a batch: the rows of one matrix are the frames of all windows, window by window,
// the longest window first. There is no padding.
struct WindowBatch {
  int count;             // windows
  int rows;              // frames of all of them
  const int* input;      // [count] index of the input
  const int* length;     // [count] frames, in descending order
  const int* first_row;  // [count]

  // At most `most` windows from `begin` on. Their rows keep their indices.
  WindowBatch Some(int begin, int most) const {
    const int size = begin + most < count ? most : count - begin;
    const int last = begin + size - 1;
    return {size, first_row[last] + length[last] - first_row[begin], input + begin, length + begin,
            first_row + begin};
  }

  // Number of windows that have a frame `step`; they are the first ones. `before` is the result for
  // an earlier step.
  int LongerThan(int step, int before) const {
    while (before > 0 && length[before - 1] <= step) --before;
    return before;
  }
};

WindowBatch MakeWindowBatch(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch);

// The paper's hierarchical generator. Read it from Run downwards: the slices' features and
// encoders, the attentive decoder in both directions, the output, the base pose.
//
// Source:  paper sections 3.1 and 3.2. The LibTorch version, model/network/generator.h, lists the
//          deviations.
// Shapes:  T frames of a window, R frames of all windows, J joints, C classes, S slices, E encoder
//          units of a slice and direction, H = S E decoder units of a direction, A rows of the
//          attention.
// Threads: Run is safe to call concurrently, with one scratch per call.
class PaperNetwork {
 public:
  PaperNetwork(const checkpoint::Checkpoint& checkpoint, kernels::Precision precision);

  // As engine::Network::Run. followers[i] has the frames and joints of inputs[i].
  void Run(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch,
           absl::Span<motion::Poses> followers) const;

 private:
  // The encoder of one slice: a body part, or the whole body.
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
  // The values that the steps of Run share.
  struct Work {
    absl::Span<const engine::NetworkInput> inputs;
    WindowBatch batch;
    const float* input;  // [R, inputs_]
    float* encoded;      // [R, 2 H]: every slice forward, then every slice backward
    float* hidden[2];    // [windows, H] of each direction: final state of the encoders, then the
                         // decoder's
    float* cell[2];
    float* states;  // [R, 2 H] of the decoder, forward and backward
  };

  // The values of one direction of the decoder for some windows.
  struct DecoderWork {
    float* encoded;   // [rows, A] U h
    float* values;    // [rows, 4 H]
    float* gates;     // [windows, 4 H + A], gates, then the query
    float* weights;   // [T] of the current window
    float** outputs;  // [windows]
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
