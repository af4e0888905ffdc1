#ifndef DUET_MODEL_CHECKPOINT_FLOW_ARCHITECTURE_H_
#define DUET_MODEL_CHECKPOINT_FLOW_ARCHITECTURE_H_

#include <string_view>
#include <vector>

#include "model/checkpoint/safetensors.h"

namespace duet::checkpoint {

struct Manifest;

// The sampling generator: a transformer over the whole window, trained by conditional flow
// matching. Every value comes from a manifest or a training configuration; none has a default.
struct FlowArchitecture {
  static constexpr std::string_view kKind = "flow";
  static constexpr std::string_view kSummary = "sampling (flow matching): answers depend on a seed";
  static constexpr bool kSamples = true;
  static bool AcceptsFollowerStart() { return true; }
  bool LabelsGuide() const { return !frame_labels; }

  int width = 0;
  int blocks = 0;
  int heads = 0;  // divides the width
  int feed_forward = 0;
  int reach = 0;  // frames; attention distinguishes distances up to this one

  // Labels are an input of every frame, so that the answer follows labels that change within a
  // window, and one evaluation of the network serves any mixture. Otherwise the network is
  // evaluated for each class, and the answers are combined by the label weights of each frame.
  bool frame_labels = false;

  // Whether the network reads which of the leader's frames are a guess
  // (NetworkInput::hidden_frames). It then serves live sessions and clips alike.
  bool hidden_frames = false;

  // One unit of the network's output, metres. The output is an offset from a base pose.
  double offset_scale = 0;

  // The source distribution of sampling: offsets like those of the training followers, smooth in
  // time.
  struct Noise {
    double frame_length = 0;    // of the squared exponential kernel over the frames
    double constant_share = 0;  // of the variance, constant over a clip; only without a start pose
    int ramp_frames = 0;        // after the last known frame until the full deviation
    double white = 0;           // standard deviation of the independent part of each frame
  } noise;

  int steps = 0;        // Euler steps from noise to motion
  double guidance = 0;  // factor of the label weights above 0
  int fade_frames = 0;  // over which the correction at the last known frame fades out
};

// Sines and cosines that encode the time of the flow, from 0 (noise) to 1 (motion).
inline constexpr int kTimeFeatures = 32;
// Distances of a frame from the window's ends, and the window's length.
inline constexpr int kPositionFeatures = 4;

// Values of each frame that the layer "frames" reads.
int64_t FrameFeatureCount(const Manifest& manifest, const FlowArchitecture& flow);

// The tensors, with W = width, F = feed_forward, J = joints, C = classes, L = FrameFeatureCount:
//   frames.weight                    [W, L]                leader, its velocity, 4 positions, known
//   frames.bias                      [W]                   frames' offsets, known or not; with
//                                                          frame_labels, C label weights; with
//                                                          hidden_frames, whether hidden
//   sample.weight                    [W, 3 J]
//   start.weight, .bias              [W, StartFeatureCount], [W]
//   label.weight                     [W, C]                absent with frame_labels
//   time.expand.weight, .bias        [W, 32], [W]
//   time.mix, condition              [W, W], [W]           .weight, .bias, as all below
//   block<i>.modulation              [4 W, W], [4 W]       shift, scale; of attention, feed-forward
//   block<i>.attention               [3 W, W], [3 W]       queries, keys, values
//   block<i>.attended                [W, W], [W]
//   block<i>.distance                [heads, 2 reach + 1]  (no .weight)
//   block<i>.expand                  [F, W], [F]
//   block<i>.contract                [W, F], [W]
//   norm                             [W], [W]
//   output                           [3 J, W], [3 J]
//   base.poses                       [C, 3 J]              mean followers, metres
//   noise.roots                      [2, 3 J, 3 J]         roots of the offsets' covariances:
//                                                          without a start, with a start
std::vector<TensorSpec> Tensors(const Manifest& manifest, const FlowArchitecture& flow);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_FLOW_ARCHITECTURE_H_
