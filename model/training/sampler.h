#ifndef DUET_MODEL_TRAINING_SAMPLER_H_
#define DUET_MODEL_TRAINING_SAMPLER_H_

#include <torch/torch.h>

#include <vector>

#include "model/dataset/dataset.h"
#include "model/network/batch.h"
#include "model/training/augment.h"
#include "model/training/example.h"
#include "model/training/options.h"

namespace duet::training {

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
StartKnowledge DrawStart(const TrainingOptions::Start& start, base::Random* random);

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
// together. Depends only on options, data and epoch. Requires a PaperTraining.
std::vector<TrainingBatch> SampleEpoch(const checkpoint::Manifest& manifest,
                                       const dataset::Dataset& dataset,
                                       const std::vector<int>& train,
                                       const TrainingOptions& options, int64_t epoch);

// The mean pose of each class's followers, [C, 3 J], in the standard coordinates.
torch::Tensor ClassMeanPoses(const checkpoint::Manifest& manifest, const dataset::Dataset& dataset,
                             const std::vector<int>& train);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_SAMPLER_H_
