#ifndef DUET_MODEL_TRAINING_SAMPLER_H_
#define DUET_MODEL_TRAINING_SAMPLER_H_

#include <torch/torch.h>

#include <vector>

#include "model/dataset/dataset.h"
#include "model/motion/poses.h"
#include "model/network/batch.h"
#include "model/training/augment.h"
#include "model/training/options.h"

namespace duet::training {

// The known part of the follower's first frame.
enum class StartKnowledge { kNone, kRoot, kPose };

// One training clip: a sequence, the conditions and the target.
struct Example {
  dataset::Sequence sequence;
  StartKnowledge start = StartKnowledge::kNone;
  std::vector<float> weights;  // [classes], the label vector
  motion::Poses target;        // [frames, joints], world metres
  bool single = true;          // the only label is the sequence's class
};

// A sequence with its own class as label and its captured follower as target.
Example CapturedExample(const dataset::Dataset& dataset, dataset::Sequence sequence,
                        StartKnowledge start);

// The clips of one training step of the paper's generator.
struct TrainingBatch {
  network::GeneratorInput input;
  torch::Tensor target;       // [N, T, 3 J] the wanted answer; standard coordinates, zero-padded
  torch::Tensor follower;     // [N, T, 3 J] captured; equals target without graded labels
  torch::Tensor classes;      // [N] int64
  torch::Tensor single_rows;  // [M] int64, the clips whose only label is their class
};

// The window that a server would make of an example.
engine::SynthesisWindow MakeWindow(const dataset::Dataset& dataset, const Example& example);

// Draws the follower start of a clip by the probabilities of `start`.
StartKnowledge DrawStart(const CommonSettings::Start& start, base::Random* random);

// Every training sequence, augmented.
std::vector<dataset::Sequence> AugmentAll(const dataset::Dataset& dataset,
                                          const std::vector<int>& train,
                                          const TrainingOptions& options, base::Random* random);

// Batches of indices of sequences, in random order. Sequences of similar length are in one batch,
// and the sizes of batches differ by at most one.
std::vector<std::vector<int>> BatchesByLength(const std::vector<dataset::Sequence>& sequences,
                                              int64_t batch, base::Random* random);

// Pads examples into a batch.
TrainingBatch MakeBatch(const checkpoint::Manifest& manifest, const dataset::Dataset& dataset,
                        const std::vector<Example>& examples);

// The batches of one epoch: every training sequence once, augmented, clips of similar length
// together. Depends only on options, data and epoch. Requires a PaperArchitecture.
std::vector<TrainingBatch> SampleEpoch(const checkpoint::Manifest& manifest,
                                       const dataset::Dataset& dataset,
                                       const std::vector<int>& train,
                                       const TrainingOptions& options, int64_t epoch);

// The mean pose of each class's followers, [C, 3 J], in the standard coordinates.
torch::Tensor ClassMeanPoses(const checkpoint::Manifest& manifest, const dataset::Dataset& dataset,
                             const std::vector<int>& train);

// Gives an example a graded, negative or mixed label vector and the matching target. The paper
// trains on single classes and uses other weights only at inference, where their effect is
// undefined. Here a weight moves the target along the line from standing still (weight 0) through
// the captured reaction (1):
//
//   30 %  own class at w in [0, 1.5]:            still + w (captured - still)
//   15 %  own class at -w in [-1, 0]:            still + w (other - still)
//   10 %  own class at 1, another below 0:       captured
//   45 %  own class at p, another at q, shares:  (1 - p' - q') still + p' captured + q' other
//
// "other" is the follower of a random clip of another class, resampled to this clip's length and
// moved to its place; with a start pose, it begins there. If `pool` (the epoch's sequences) has no
// other class, the example does not change.
void GradeLabels(const dataset::Dataset& dataset, const std::vector<dataset::Sequence>& pool,
                 base::Random* random, Example* example);

// The label weights of every frame of a sequence, in random variants from which a generator with
// frame_labels learns the meaning of a weight: 1 for a class of the frame, 0 where nothing is said
// of the class, -1 where it is absent and avoided. A sequence without a time line has its class in
// every frame. Returns [frames, classes].
std::vector<float> DrawFrameLabels(const dataset::Sequence& sequence, int classes,
                                   const FlowSettings::FrameLabels& options, base::Random* random);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_SAMPLER_H_
