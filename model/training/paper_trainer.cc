#include "model/training/paper_trainer.h"

#include <utility>

#include "model/network/losses.h"
#include "model/network/parameters.h"

namespace duet::training {
namespace {

int64_t Steps(size_t count, int64_t batch) {
  return (static_cast<int64_t>(count) + batch - 1) / batch;
}

network::Generator MakeGenerator(const TrainingOptions& options,
                                 const checkpoint::Manifest& manifest) {
  torch::manual_seed(options.seed);
  network::Generator generator(manifest);
  const PaperTraining::Dropout& dropout = std::get<PaperTraining>(options.method).dropout;
  generator->set_dropout(dropout.slices, dropout.encoded);
  return generator;
}

torch::Tensor Reconstruction(const std::string& form, const torch::Tensor& predicted,
                             const TrainingBatch& batch) {
  const torch::Tensor& lengths = batch.input.lengths;
  if (form == "l2") return network::L2Loss(predicted, batch.target, lengths);
  if (form == "norm") return network::NormLoss(predicted, batch.target, lengths);
  return network::L1Loss(predicted, batch.target, lengths);
}

network::ContinuityOptions Continuity(const PaperTraining::Losses& losses) {
  return {losses.continuity_form == "hinge" ? network::ContinuityForm::kHinge
                                            : network::ContinuityForm::kPathLength,
          losses.continuity_gap, losses.continuity_margin};
}

}  // namespace

PaperTrainer::PaperTrainer(const TrainingOptions& options, const checkpoint::Manifest& manifest,
                           const dataset::Dataset& dataset, std::vector<int> train,
                           std::vector<int> validation)
    : EpochTrainer(options, manifest, dataset, std::move(train), std::move(validation)),
      losses_(std::get<PaperTraining>(options.method).losses),
      steps_per_epoch_(Steps(train_.size(), options.batch)),
      generator_(MakeGenerator(options, manifest)),
      generator_optimiser_(options.optimiser, generator_->parameters(),
                           steps_per_epoch_ * options.epochs) {
  if (losses_.adversarial > 0) {
    adversary_ = std::make_unique<Adversary>(options, manifest, steps_per_epoch_ * options.epochs);
  }
  if (std::get<checkpoint::PaperArchitecture>(manifest.architecture).base_pose) {
    generator_->SetBasePoses(ClassMeanPoses(manifest, dataset, train_));
  }
  Begin(generator_.get());
}

torch::Tensor PaperTrainer::GeneratorLoss(const TrainingBatch& batch, EpochReport* report) {
  const torch::Tensor& lengths = batch.input.lengths;
  const torch::Tensor predicted = generator_->forward(batch.input);
  torch::Tensor total = torch::zeros({});
  const auto add = [&](double weight, const torch::Tensor& loss, double* mean) {
    total = total + weight * loss;
    *mean += loss.item<double>() / static_cast<double>(steps_per_epoch_);
  };
  add(losses_.reconstruction_weight, Reconstruction(losses_.reconstruction, predicted, batch),
      &report->reconstruction);
  if (losses_.bone > 0) {
    add(losses_.bone,
        network::BoneLoss(predicted, batch.follower, lengths, manifest_.model.skeleton.bones),
        &report->bone);
  }
  if (losses_.continuity > 0) {
    add(losses_.continuity, network::ContinuityLoss(predicted, lengths, Continuity(losses_)),
        &report->continuity);
  }
  if (adversary_ != nullptr) {
    add(losses_.adversarial, adversary_->GeneratorLoss(batch, predicted), &report->adversarial);
  }
  report->generator += total.item<double>() / static_cast<double>(steps_per_epoch_);
  return total;
}

void PaperTrainer::TrainAdversary(const TrainingBatch& batch, int64_t step, EpochReport* report) {
  torch::Tensor synthesised;
  {
    torch::NoGradGuard no_grad;
    synthesised = generator_->forward(batch.input);
  }
  report->discriminator +=
      adversary_->Train(batch, synthesised, step) / static_cast<double>(steps_per_epoch_);
}

void PaperTrainer::TrainEpoch(int64_t first_step, EpochReport* report) {
  int64_t step = first_step;
  for (const TrainingBatch& batch : SampleEpoch(manifest_, dataset_, train_, options_, epoch())) {
    if (adversary_ != nullptr) TrainAdversary(batch, step, report);
    GeneratorLoss(batch, report).backward();
    generator_optimiser_.Step(step);
    UpdateAverage(options_.optimiser.average_decay);
    ++step;
  }
}

double PaperTrainer::ValidationError(const Example& example) {
  const TrainingBatch one = MakeBatch(manifest_, dataset_, {example});
  return network::NormLoss(generator_->forward(one.input), one.follower, one.input.lengths)
      .item<double>();
}

network::Generator PaperTrainer::Best() {
  network::Generator best(manifest_);
  CopyBest(best.get());
  return best;
}

std::vector<checkpoint::Tensor> PaperTrainer::BestTensors() {
  return network::StoreParameters(manifest_, Best());
}

std::vector<std::pair<std::string, torch::Tensor>> PaperTrainer::MoreTensors() {
  if (adversary_ == nullptr) return {};
  return adversary_->Tensors();
}

absl::Status PaperTrainer::LoadWeights(const checkpoint::Checkpoint& checkpoint) {
  return network::LoadParameters(checkpoint, generator_);
}

std::vector<std::pair<std::string, torch::optim::Optimizer*>> PaperTrainer::StateOptimisers() {
  std::vector<std::pair<std::string, torch::optim::Optimizer*>> optimisers;
  if (adversary_ != nullptr) optimisers = adversary_->Optimisers();
  optimisers.emplace_back("generator_optimiser", &generator_optimiser_.state());
  return optimisers;
}

}  // namespace duet::training
