#ifndef DUET_MODEL_TRAINING_PAPER_TRAINER_H_
#define DUET_MODEL_TRAINING_PAPER_TRAINER_H_

#include <torch/torch.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/checkpoint/checkpoint.h"
#include "model/dataset/dataset.h"
#include "model/network/generator.h"
#include "model/training/adversary.h"
#include "model/training/epoch_trainer.h"
#include "model/training/optimiser.h"
#include "model/training/options.h"
#include "model/training/sampler.h"

namespace duet::training {

// Trains the paper's generator, with an adversarial loss against its discriminator if the options
// ask for one.
//
// Source:  paper section 3.4 and 5. The discriminator is frozen in the generator's step.
class PaperTrainer : public EpochTrainer {
 public:
  // `manifest` describes the model to train. Its architecture must be that of options.method, a
  // PaperTraining.
  PaperTrainer(const TrainingOptions& options, const checkpoint::Manifest& manifest,
               const dataset::Dataset& dataset, std::vector<int> train,
               std::vector<int> validation);

  // The generator whose tensors BestTensors returns.
  network::Generator Best();
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

  const PaperTraining::Losses& losses_;
  int64_t steps_per_epoch_;
  network::Generator generator_;
  Optimiser generator_optimiser_;
  std::unique_ptr<Adversary> adversary_;  // null without an adversarial loss
};

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_PAPER_TRAINER_H_
