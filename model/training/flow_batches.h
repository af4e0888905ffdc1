#ifndef DUET_MODEL_TRAINING_FLOW_BATCHES_H_
#define DUET_MODEL_TRAINING_FLOW_BATCHES_H_

#include <torch/torch.h>

#include <functional>
#include <vector>

#include "model/base/random.h"
#include "model/checkpoint/manifest.h"
#include "model/dataset/dataset.h"
#include "model/engine/network.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/network/flow_generator.h"
#include "model/training/sampler.h"

namespace duet::training {

// The clips of one training step of the sampling generator.
struct FlowBatch {
  network::FlowInput input;
  torch::Tensor labels;  // [N, C] the class, or zeros if it is withheld
  torch::Tensor target;  // [N, T, 3 J] offsets from input.base, in offset_scale metres
  torch::Tensor live;    // [N, 1, 1] of bool: see FlowExample; undefined if none is live
};

// A captured example in the standard coordinates, its follower smoothed.
struct FlowExample {
  engine::NetworkInput input;
  motion::Poses target;
  bool unlabelled = false;  // the label is withheld from the network
  bool live = false;        // a window of a live session, whose noise belongs to an endless motion
};
FlowExample MakeFlowExample(const checkpoint::Manifest& manifest, const dataset::Dataset& dataset,
                            const Example& example, double smoothing);

// The passes of an epoch over `sequences` training sequences, and the steps that it takes: as set,
// or as many more as the run needs for its least number of steps. Require a FlowArchitecture.
int64_t PassesPerEpoch(const TrainingOptions& options, size_t sequences);
int64_t StepsPerEpoch(const TrainingOptions& options, size_t sequences);

// The clips of one epoch in batches: every training sequence once in every pass, augmented, with no
// start, the root, the first pose or several known frames. Depends only on options, data and epoch.
// Requires a FlowArchitecture.
using FlowEpoch = std::vector<std::vector<FlowExample>>;
FlowEpoch DrawFlowEpoch(const checkpoint::Manifest& manifest, const dataset::Dataset& dataset,
                        const std::vector<int>& train, const TrainingOptions& options,
                        int64_t epoch);

// Shapes: base_poses [C, 3 J]. Requires a FlowArchitecture.
FlowBatch MakeFlowBatch(const checkpoint::Manifest& manifest, const torch::Tensor& base_poses,
                        const std::vector<FlowExample>& examples);

// The tensors of the sampling generator that are measured on the training followers, each of them
// counted as captured and mirrored.
struct FlowStatistics {
  // [C, 3 J] mean pose of each class, metres.
  torch::Tensor base_poses;
  // [2, 3 J, 3 J] symmetric roots of the mean square of the offsets, in offset_scale metres: from
  // the class's mean pose, from the first pose.
  torch::Tensor noise_roots;
  // [C] root of the mean square of a class's offsets from its mean pose, in offset_scale metres. A
  // class without followers has that of all.
  torch::Tensor spreads;
};

// Requires a FlowArchitecture. `smoothing`: see FlowSettings::Flow::target_smoothing.
FlowStatistics MeasureFollowers(const checkpoint::Manifest& manifest,
                                const dataset::Dataset& dataset, const std::vector<int>& train,
                                double smoothing);

// Adds an error to the known first frames of a follower: tilts, bends, turns and displaces
// them, like a follower that has continued from its own answers for a while. The target starts with
// the same error and reaches the captured motion `options.frames` frames after the last known one.
// Requires a start pose. Shapes: target [frames, joints], as the input's leader. Source: like
// training on roll-outs (Ross et al. 2011), with invented errors.
void AddDrift(const motion::Skeleton& skeleton, const FlowSettings::Drift& options,
              base::Random* random, engine::NetworkInput* input, motion::Poses* target);

// Makes a window of a live session (engine::LiveSynthesis) of an example: at a random frame "now",
// up to `live.remade_seconds` after the last known frame, the leader is known for up to
// `live.delay_seconds` more and then comes to rest; the labels stay as they are now; and the window
// ends `live.future_seconds` after now. The target does not change.
//
// Units: frame_rate_hz of the example.
void HideFuture(const motion::Skeleton& skeleton, double frame_rate_hz,
                const FlowSettings::Live& live, base::Random* random, FlowExample* example);

// Answers of the network in training: one follower for each input, with its seed.
using Answer = std::function<std::vector<motion::Poses>(absl::Span<const engine::NetworkInput>)>;

// Lets examples continue from the network's own motion, as in long clips and live sessions, instead
// of a captured one. Of the examples with several known frames, each with probability `own.share`:
// the last of these frames, up to own.most_frames, are replaced by the network's answer, and
// the target becomes the captured motion plus what the answer differed by, which fades out over
// own.return_frames. The limbs of the target keep their captured lengths.
void ContinueOwnMotion(const motion::Skeleton& skeleton, const FlowSettings::Own& own,
                       const Answer& answer, base::Random* random,
                       std::vector<FlowExample>* examples);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_FLOW_BATCHES_H_
