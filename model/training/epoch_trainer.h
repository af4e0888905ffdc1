#ifndef DUET_MODEL_TRAINING_EPOCH_TRAINER_H_
#define DUET_MODEL_TRAINING_EPOCH_TRAINER_H_

#include <torch/torch.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "model/checkpoint/checkpoint.h"
#include "model/dataset/dataset.h"
#include "model/training/options.h"
#include "model/training/sampler.h"

namespace duet::training {

// The mean of each loss over an epoch, unweighted. Without validation its figures are NaN.
struct EpochReport {
  int64_t epoch = 0;  // from 1
  int64_t epochs = 0;
  double generator = 0;  // the weighted sum
  double reconstruction = 0;
  double bone = 0;
  double continuity = 0;  // sampling generator: error of differences of successive frames
  double adversarial = 0;
  double discriminator = 0;
  // Sampling generator: the losses are energy scores of whole answers (energy.from), on another
  // scale than those of the epochs before.
  bool whole_answers = false;
  double validation_afd = 0;       // metres, without a follower start
  double validation_afd_pose = 0;  // with the follower's first pose; NaN if the model accepts none
  double seconds = 0;
};

// Trains a generator, epoch by epoch. Every epoch depends only on the state before it, the options
// and the data: on one thread, a run that was stopped and resumed is bit-identical to one that was
// not. The derived class defines the generator and its losses.
//
// Threads: not safe to call concurrently.
class EpochTrainer {
 public:
  // `validation` may be empty. Options, manifest and data set must outlive the trainer.
  EpochTrainer(const TrainingOptions& options, const checkpoint::Manifest& manifest,
               const dataset::Dataset& dataset, std::vector<int> train,
               std::vector<int> validation);
  virtual ~EpochTrainer() = default;
  EpochTrainer(const EpochTrainer&) = delete;
  EpochTrainer& operator=(const EpochTrainer&) = delete;

  virtual int64_t steps_per_epoch() const = 0;
  // Number of completed epochs.
  int64_t epoch() const { return epoch_; }
  bool Finished() const { return epoch_ >= options_.common.epochs(); }

  // Trains on a device of LibTorch: "cpu" or "cuda". INVALID_ARGUMENT if the method
  // cannot, FAILED_PRECONDITION if LibTorch cannot. Requires that nothing else was called before.
  virtual absl::Status UseDevice(const std::string& device);

  // Begins with the weights of a checkpoint instead of random ones. INVALID_ARGUMENT names a tensor
  // that is missing or has another shape. Requires that no epoch was run.
  absl::Status StartFrom(const checkpoint::Checkpoint& checkpoint);

  EpochReport RunEpoch();

  // The epoch whose generator results, from 1, and its validation error without a follower start;
  // infinite without validation.
  int64_t best_epoch() const { return best_epoch_; }
  double best_afd() const { return best_afd_; }

  // Saves and restores everything that the next epoch depends on. A state of other options, data
  // or version is FAILED_PRECONDITION. The file is trusted: load only files of your own runs.
  absl::Status SaveState(const std::filesystem::path& file);
  absl::Status LoadState(const std::filesystem::path& file);

  // The resulting generator, in the order of ExpectedTensors: that of the epoch with the best
  // validation error among those that may result, or without validation of the last epoch;
  // averaged if so configured.
  virtual std::vector<checkpoint::Tensor> BestTensors() = 0;

 protected:
  // Sets the generator to train, already initialised. The derived class's constructor calls it
  // once.
  void Begin(torch::nn::Module* generator);

  // Runs the steps of one epoch, from step number `first_step` on, and calls UpdateAverage after
  // each.
  virtual void TrainEpoch(int64_t first_step, EpochReport* report) = 0;
  // Whether an epoch, counted from 0, may result. A method that trains in parts rules out the
  // epochs before the last part: they do not yet have what that part teaches.
  virtual bool MayBeBest(int64_t /*epoch*/) const { return true; }
  // Copies the weights of a checkpoint into the generator, except what was measured on the training
  // data. INVALID_ARGUMENT names a tensor that is missing or has another shape.
  virtual absl::Status LoadWeights(const checkpoint::Checkpoint& checkpoint) = 0;
  // The error of the generator's answer to a captured example: AFD, metres.
  virtual double ValidationError(const Example& example) = 0;
  // State to save and restore in addition to the generator, its average and the best one.
  virtual std::vector<std::pair<std::string, torch::Tensor>> MoreTensors() { return {}; }
  virtual std::vector<std::pair<std::string, torch::optim::Optimizer*>> StateOptimisers() = 0;

  // Moves the average towards the parameters: it keeps the fraction `decay`.
  void UpdateAverage(double decay);
  // Copies the resulting parameters into a generator of the same manifest.
  void CopyBest(torch::nn::Module* generator) const;

  const TrainingOptions& options_;
  const checkpoint::Manifest& manifest_;
  const dataset::Dataset& dataset_;
  const std::vector<int> train_, validation_;

 private:
  // The mean error of the averaged generator over the validation sequences; NaN without any.
  double Validate(StartKnowledge start);
  // Keeps the weights of the epoch that has just ended if they are the best so far. `afd`: its
  // validation error.
  void Choose(double afd);
  std::string Identity() const;
  std::vector<std::pair<std::string, torch::Tensor>> StateTensors();

  torch::nn::Module* generator_ = nullptr;
  std::vector<torch::Tensor> average_;  // of the generator's parameters
  std::vector<torch::Tensor> best_;     // parameters of the best validated epoch
  double best_afd_;
  int64_t best_epoch_ = 0;
  int64_t epoch_ = 0;
};

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_EPOCH_TRAINER_H_
