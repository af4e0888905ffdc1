#ifndef DUET_MODEL_TRAINING_TRAINER_H_
#define DUET_MODEL_TRAINING_TRAINER_H_

#include <torch/torch.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/dataset/dataset.h"
#include "model/network/generator.h"
#include "model/training/adversary.h"
#include "model/training/optimiser.h"
#include "model/training/options.h"
#include "model/training/sampler.h"

namespace duet::training {

// The mean of every loss over an epoch, unweighted; validation figures are NaN when there is none.
struct EpochReport {
  int64_t epoch = 0;  // from 1
  int64_t epochs = 0;
  double generator = 0;  // the weighted sum
  double reconstruction = 0;
  double bone = 0;
  double continuity = 0;
  double adversarial = 0;
  double discriminator = 0;
  double validation_afd = 0;       // metres, without a follower start
  double validation_afd_pose = 0;  // told the follower's first pose; NaN where a model takes none
  double seconds = 0;
};

// Trains a generator, epoch by epoch. Every epoch is a function of the state before it, the options
// and the data alone: a run that was stopped and resumed equals one that was not, bit for bit on
// one thread.
//
// Source:  paper section 3.4 and 5. The discriminator is frozen in the generator's step.
// Threads: not safe to call concurrently.
class Trainer {
 public:
  // `manifest` describes the model to be; its generator must be options.generator, with parts.
  // `validation` may be empty. Options, manifest and data set must outlive the trainer.
  Trainer(const TrainingOptions& options, const checkpoint::Manifest& manifest,
          const dataset::Dataset& dataset, std::vector<int> train, std::vector<int> validation);

  // Epochs done so far.
  int64_t epoch() const { return epoch_; }
  // True when all epochs are done or validation has stopped improving.
  bool Finished() const;

  EpochReport RunEpoch();

  // Saves and restores everything that the next epoch depends on. A state of other options, data
  // or version is FAILED_PRECONDITION. The file is this machine's own, never a checkpoint to pass
  // around.
  absl::Status SaveState(const std::filesystem::path& file);
  absl::Status LoadState(const std::filesystem::path& file);

  // The generator to keep: of the best validated epoch, or the last; averaged when so configured.
  network::Generator Best();

 private:
  torch::Tensor GeneratorLoss(const TrainingBatch& batch, EpochReport* report);
  void TrainAdversary(const TrainingBatch& batch, int64_t step, EpochReport* report);
  void UpdateAverage();
  double Validate(StartKnowledge start);
  std::string Identity() const;
  std::vector<std::pair<std::string, torch::Tensor>> StateTensors();
  std::vector<std::pair<std::string, torch::optim::Optimizer*>> StateOptimisers();

  const TrainingOptions& options_;
  const checkpoint::Manifest& manifest_;
  const dataset::Dataset& dataset_;
  std::vector<int> train_, validation_;
  int64_t steps_per_epoch_;
  network::Generator generator_;
  Optimiser generator_optimiser_;
  std::unique_ptr<Adversary> adversary_;  // null without an adversarial loss
  std::vector<torch::Tensor> average_;    // of the generator's parameters
  std::vector<torch::Tensor> best_;       // parameters of the best validated epoch
  double best_afd_;
  int64_t best_epoch_ = 0;
  int64_t epoch_ = 0;
};

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_TRAINER_H_
