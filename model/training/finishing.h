#ifndef DUET_MODEL_TRAINING_FINISHING_H_
#define DUET_MODEL_TRAINING_FINISHING_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/dataset/dataset.h"
#include "model/engine/direction_estimate.h"
#include "model/engine/synthesizer.h"
#include "model/training/options.h"

// What is learnt from captured pairs without a generator, and from the answers of a finished one.

namespace duet::training {

// Fills in what captured pairs show about how people meet: contacts of hands of each class, from
// the windows `train` that the data set is cut into; how far followers are turned away, and how
// large they are, from the `takes` of the whole data set.
void MeasurePairs(const dataset::Dataset& whole, const std::vector<int>& takes,
                  const dataset::Dataset& dataset, const std::vector<int>& train,
                  engine::ModelDescription* model);

// A finished generator that samples, with the stages of a server around it. `checkpoint` has to
// outlive it. Errors: tensors that do not fit the manifest.
absl::StatusOr<std::unique_ptr<engine::Synthesizer>> SynthesizerOf(
    const checkpoint::Checkpoint& checkpoint);

// The answers to any number of windows, in order.
std::vector<engine::WindowResult> AnswerAll(const engine::Synthesizer& synthesizer,
                                            const std::vector<engine::SynthesisWindow>& windows);

// A trained critic and its mean loss in the last tenth of the steps; 0.69: it cannot tell captured
// followers from sampled ones.
struct TrainedCritic {
  std::vector<checkpoint::Tensor> tensors;  // in the order of checkpoint::CriticTensors
  double loss = 0;
};

// Trains a critic (model/engine/critic.h) for a finished generator, on one device and in a few
// seconds. It learns to tell the captured followers of the sequences `train` from the generator's
// own answers to their leaders. Both pass the stages of a server, with and without a first pose.
// The result depends only on the arguments. Errors: INTERNAL if an answer is not finite.
// Requires a generator that samples, at least one sequence and at least one step.
absl::StatusOr<TrainedCritic> TrainCritic(const FlowSettings& flow, uint64_t seed,
                                          const checkpoint::Checkpoint& generator,
                                          const dataset::Dataset& dataset,
                                          const std::vector<int>& train);

// Chooses the seeds that a server draws from for callers who name none: of many seeds, those whose
// followers get as far, and come as near their leaders, as captured ones do, in every class. Most
// of what a seed changes is the same for all leaders of a class, so a seed whose followers hardly
// move beside training leaders hardly moves beside others. The best comes first. The result depends
// only on the arguments.
//
// Errors: INTERNAL if an answer is not finite. Requires a generator that samples, and at least one
// sequence in `train`.
absl::StatusOr<std::vector<uint64_t>> ChooseDefaultSeeds(const engine::Synthesizer& synthesizer,
                                                         const dataset::Dataset& dataset,
                                                         const std::vector<int>& train);

// Fits a regression of the partner's direction on the leader's motion. The training set is each
// leader as captured and mirrored; in symmetric classes the follower is another leader. The first
// estimate learns every leader also from behind, because a capture may confuse left and right hips.
// Returns nothing if the captures' setup does not define the direction, or no leader's hips have
// one: such a model answers in the frame of the hips, as it was trained to.
//
// Source: ridge regressions in closed form; the penalties were chosen on SBU with held-out people.
std::optional<engine::DirectionRegression> FitPartnerDirection(const dataset::Dataset& dataset,
                                                               const std::vector<int>& train);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_FINISHING_H_
