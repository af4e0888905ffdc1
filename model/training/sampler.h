#ifndef DUET_MODEL_TRAINING_SAMPLER_H_
#define DUET_MODEL_TRAINING_SAMPLER_H_

#include <torch/torch.h>

#include <vector>

#include "model/dataset/dataset.h"
#include "model/network/batch.h"
#include "model/training/augment.h"
#include "model/training/options.h"

namespace duet {

// One step's clips.
struct TrainingBatch {
  network::GeneratorInput input;
  torch::Tensor follower;  // [N, T, 3 J] standard frame, zero-padded
  torch::Tensor classes;   // [N] int64
};

// What of the follower's first frame a clip is told.
enum class StartKnowledge { kNone, kRoot, kPose };

// A sequence as the network is given it: the window that a server would make of it.
SynthesisWindow MakeWindow(const Dataset& dataset, const Sequence& sequence, StartKnowledge start);

// Pads sequences into a batch; `starts` names what each is told.
TrainingBatch MakeBatch(const Manifest& manifest, const Dataset& dataset,
                        const std::vector<Sequence>& sequences,
                        const std::vector<StartKnowledge>& starts);

// The batches of one epoch: every training sequence once, augmented, clips of like length together.
// Depends on options, data and epoch alone.
std::vector<TrainingBatch> SampleEpoch(const Manifest& manifest, const Dataset& dataset,
                                       const std::vector<int>& train,
                                       const TrainingOptions& options, int64_t epoch);

// The mean pose of each class's followers, [C, 3 J], in the standard frame.
torch::Tensor ClassMeanPoses(const Manifest& manifest, const Dataset& dataset,
                             const std::vector<int>& train);

}  // namespace duet

#endif  // DUET_MODEL_TRAINING_SAMPLER_H_
