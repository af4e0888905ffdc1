#ifndef DUET_MODEL_TRAINING_FLOW_TRAINER_H_
#define DUET_MODEL_TRAINING_FLOW_TRAINER_H_

#include <torch/torch.h>

#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/motion/skeleton.h"
#include "model/network/flow_generator.h"
#include "model/training/epoch_trainer.h"
#include "model/training/flow_batches.h"
#include "model/training/optimiser.h"

namespace duet::training {

// Adds up losses for the report of an epoch. Values are read only at the end, because reading one
// from an accelerator waits for it.
class LossMeans {
 public:
  // The losses added for one `mean` in one step count as its value in that step.
  void Add(double* mean, const torch::Tensor& loss) { losses_.emplace_back(mean, loss.detach()); }

  // Adds the losses divided by `steps` to their means.
  void Write(int64_t steps) {
    for (const auto& [mean, loss] : losses_) {
      *mean += loss.item<double>() / static_cast<double>(steps);
    }
    losses_.clear();
  }

 private:
  std::vector<std::pair<double*, torch::Tensor>> losses_;
};

// Trains the sampling generator, first by conditional flow matching: from (1 - t) noise + t motion
// for a random t, it learns to predict the motion. Then by the energy score of whole answers, after
// which few sampling steps are enough.
//
// Source:  Lipman et al. 2023; docs/decisions/method.md.
class FlowTrainer : public EpochTrainer {
 public:
  // `manifest` describes the model to train. Its architecture must be that of the options, a
  // FlowArchitecture.
  FlowTrainer(const TrainingOptions& options, const checkpoint::Manifest& manifest,
              const dataset::Dataset& dataset, std::vector<int> train, std::vector<int> validation);

  std::vector<checkpoint::Tensor> BestTensors() override;

  int64_t steps_per_epoch() const override { return steps_per_epoch_; }
  absl::Status UseDevice(const std::string& device) override;

 private:
  void TrainEpoch(int64_t first_step, EpochReport* report) override;
  bool MayBeBest(int64_t epoch) const override;
  // Whether an epoch, counted from 0, is in the part that scores whole answers.
  bool ScoresAnswers(int64_t epoch) const;
  absl::Status LoadWeights(const checkpoint::Checkpoint& checkpoint) override;
  // The error of the typical answer: variety 0.
  double ValidationError(const Example& example) override;
  std::vector<std::pair<std::string, torch::optim::Optimizer*>> StateOptimisers() override;
  // The clips of the current epoch. Those of the next one are drawn meanwhile, on another thread.
  FlowEpoch TakeEpoch();
  // A batch on the network's device. Its clips may first continue the network's own motion.
  FlowBatch NextBatch(base::Random* random, std::vector<FlowExample>* examples) const;
  torch::Tensor MatchingLoss(const FlowBatch& batch, EpochReport* report);
  torch::Tensor EnergyLoss(const FlowBatch& batch, EpochReport* report);
  torch::Tensor DrawSource(const FlowBatch& batch) const;
  // [N] the weight of each clip's loss, 1 without a label; see FlowSettings::Flow::class_balance.
  torch::Tensor ClipWeights(const FlowBatch& batch) const;
  // The scores of feet and hands; see FlowSettings::Energy.
  template <typename Add>
  void AddBodyScores(const FlowBatch& batch, const torch::Tensor& answers, const Add& add,
                     EpochReport* report);

  const FlowSettings& flow_;
  const checkpoint::FlowArchitecture& architecture_;
  std::optional<motion::JointPair> hands_;
  int64_t steps_per_epoch_;
  network::FlowGenerator generator_;
  torch::Tensor base_poses_;     // the generator's, in the processor's memory
  torch::Tensor class_weights_;  // [C] see FlowSettings::Flow::class_balance
  Optimiser optimiser_;
  LossMeans means_;
  int64_t drawn_epoch_ = -1;
  std::future<FlowEpoch> drawn_;  // last: its thread reads the other members
};

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_FLOW_TRAINER_H_
