#ifndef DUET_MODEL_TRAINING_PAPER_TRAINER_H_
#define DUET_MODEL_TRAINING_PAPER_TRAINER_H_

#include <torch/torch.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/checkpoint/checkpoint.h"
#include "model/checkpoint/manifest.h"
#include "model/dataset/dataset.h"
#include "model/network/discriminator.h"
#include "model/network/generator.h"
#include "model/training/epoch_trainer.h"
#include "model/training/optimiser.h"
#include "model/training/options.h"
#include "model/training/sampler.h"

namespace duet::training {

// The discriminators that the paper's generator is trained against: the class-aware one and, if the
// options ask for it, a binary one that only separates real from synthesised motion (MSHL22).
//
// Source:  paper section 3.3 and Eq. 4; MSHL22.
// Threads: not safe to call concurrently.
class Adversary {
 public:
  // Requires losses.adversarial above 0. `steps` is the number of steps of the whole run, for the
  // schedule.
  Adversary(const TrainingOptions& options, const checkpoint::Manifest& manifest, int64_t steps);

  // One step of every discriminator on captured and synthesised followers [N, T, 3 J]. Returns the
  // sum of their losses.
  double Train(const TrainingBatch& batch, const torch::Tensor& synthesised, int64_t step);

  // The generator's loss, a scalar: the sum over the discriminators, which get no gradient. Only
  // clips with a single class count, because a mixed answer has no one target class; 0 without such
  // clips.
  torch::Tensor GeneratorLoss(const TrainingBatch& batch, const torch::Tensor& synthesised);

  // The state that a resumed run restores: parameters by name, and the optimisers.
  std::vector<std::pair<std::string, torch::Tensor>> Tensors();
  std::vector<std::pair<std::string, torch::optim::Optimizer*>> Optimisers();

 private:
  struct Critic {
    std::string name;
    bool class_aware;
    network::Discriminator network;
    std::unique_ptr<Optimiser> optimiser;
  };

  void Add(const std::string& name, bool class_aware, const checkpoint::Manifest& manifest,
           int64_t steps);

  const TrainingOptions& options_;
  const PaperSettings::Discriminator& settings_;
  std::vector<Critic> critics_;
};

// Trains the paper's generator, with an adversarial loss against its discriminator if the options
// ask for one.
//
// Source:  paper section 3.4 and 5. The discriminator is frozen in the generator's step.
class PaperTrainer : public EpochTrainer {
 public:
  // `manifest` describes the model to train. Its architecture must be that of the options, a
  // PaperArchitecture.
  PaperTrainer(const TrainingOptions& options, const checkpoint::Manifest& manifest,
               const dataset::Dataset& dataset, std::vector<int> train,
               std::vector<int> validation);

  std::vector<checkpoint::Tensor> BestTensors() override;

  int64_t steps_per_epoch() const override { return steps_per_epoch_; }

 private:
  void TrainEpoch(int64_t first_step, EpochReport* report) override;
  absl::Status LoadWeights(const checkpoint::Checkpoint& checkpoint) override;
  double ValidationError(const Example& example) override;
  std::vector<std::pair<std::string, torch::Tensor>> MoreTensors() override;
  std::vector<std::pair<std::string, torch::optim::Optimizer*>> StateOptimisers() override;
  torch::Tensor GeneratorLoss(const TrainingBatch& batch, EpochReport* report);
  void TrainAdversary(const TrainingBatch& batch, int64_t step, EpochReport* report);

  const PaperSettings::Losses& losses_;
  int64_t steps_per_epoch_;
  network::Generator generator_;
  Optimiser generator_optimiser_;
  std::unique_ptr<Adversary> adversary_;  // null without an adversarial loss
};

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_PAPER_TRAINER_H_
