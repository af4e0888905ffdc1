#include "model/training/paper_trainer.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "model/network/losses.h"
#include "model/network/parameters.h"

namespace duet::training {
namespace {

int64_t Steps(size_t count, int64_t batch) {
  return (static_cast<int64_t>(count) + batch - 1) / batch;
}

network::Generator MakeGenerator(const TrainingOptions& options,
                                 const checkpoint::Manifest& manifest) {
  torch::manual_seed(options.common.seed());
  network::Generator generator(manifest);
  const PaperSettings::Dropout& dropout = options.paper.dropout();
  generator->set_dropout(dropout.slices(), dropout.encoded());
  return generator;
}

network::ContinuityForm Continuity(const PaperSettings::Losses& losses) {
  return losses.continuity_form() == PaperSettings::Losses::HINGE
             ? network::ContinuityForm::kHinge
             : network::ContinuityForm::kPathLength;
}

}  // namespace

PaperTrainer::PaperTrainer(const TrainingOptions& options, const checkpoint::Manifest& manifest,
                           const dataset::Dataset& dataset, std::vector<int> train,
                           std::vector<int> validation)
    : EpochTrainer(options, manifest, dataset, std::move(train), std::move(validation)),
      losses_(options.paper.losses()),
      steps_per_epoch_(Steps(train_.size(), options.common.batch())),
      generator_(MakeGenerator(options, manifest)),
      generator_optimiser_(options.common.optimiser(), generator_->parameters(),
                           steps_per_epoch_ * options.common.epochs()) {
  if (losses_.adversarial() > 0) {
    adversary_ =
        std::make_unique<Adversary>(options, manifest, steps_per_epoch_ * options.common.epochs());
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
  add(1, network::L1Loss(predicted, batch.target, lengths), &report->reconstruction);
  if (losses_.bone() > 0) {
    add(losses_.bone(),
        network::BoneLoss(predicted, batch.follower, lengths, manifest_.model.skeleton.bones),
        &report->bone);
  }
  if (losses_.continuity() > 0) {
    add(losses_.continuity(), network::ContinuityLoss(predicted, lengths, Continuity(losses_)),
        &report->continuity);
  }
  if (adversary_ != nullptr) {
    add(losses_.adversarial(), adversary_->GeneratorLoss(batch, predicted), &report->adversarial);
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
    UpdateAverage(options_.common.optimiser().average_decay());
    ++step;
  }
}

double PaperTrainer::ValidationError(const Example& example) {
  const TrainingBatch one = MakeBatch(manifest_, dataset_, {example});
  return network::NormLoss(generator_->forward(one.input), one.follower, one.input.lengths)
      .item<double>();
}

std::vector<checkpoint::Tensor> PaperTrainer::BestTensors() {
  network::Generator best(manifest_);
  CopyBest(best.get());
  return network::StoreParameters(manifest_, best);
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

namespace {

CommonSettings::Optimiser OptimiserOptions(const TrainingOptions& options) {
  CommonSettings::Optimiser optimiser = options.common.optimiser();
  optimiser.set_learning_rate(options.paper.discriminator().learning_rate());
  return optimiser;
}

// Disables the gradients of a module's parameters during its lifetime.
class Frozen {
 public:
  explicit Frozen(torch::nn::Module& module) : module_(module) { Set(false); }
  ~Frozen() { Set(true); }
  Frozen(const Frozen&) = delete;
  Frozen& operator=(const Frozen&) = delete;

 private:
  void Set(bool on) {
    for (torch::Tensor& parameter : module_.parameters()) parameter.set_requires_grad(on);
  }
  torch::nn::Module& module_;
};

}  // namespace

Adversary::Adversary(const TrainingOptions& options, const checkpoint::Manifest& manifest,
                     int64_t steps)
    : options_(options), settings_(options.paper.discriminator()) {
  Add("discriminator", true, manifest, steps);
  if (settings_.binary()) Add("binary_discriminator", false, manifest, steps);
}

void Adversary::Add(const std::string& name, bool class_aware, const checkpoint::Manifest& manifest,
                    int64_t steps) {
  network::DiscriminatorOptions sizes;
  sizes.input = 3 * manifest.model.skeleton.joint_count();
  sizes.window_frames = manifest.model.window_frames;
  sizes.hidden = settings_.hidden();
  sizes.outputs = class_aware ? manifest.model.class_count() + 1 : 2;
  network::Discriminator network(sizes);
  network->set_dropout(settings_.dropout());
  auto optimiser =
      std::make_unique<Optimiser>(OptimiserOptions(options_), network->parameters(), steps);
  critics_.push_back({name, class_aware, network, std::move(optimiser)});
}

double Adversary::Train(const TrainingBatch& batch, const torch::Tensor& synthesised,
                        int64_t step) {
  double sum = 0;
  const torch::Tensor& lengths = batch.input.lengths;
  for (Critic& critic : critics_) {
    const torch::Tensor classes =
        critic.class_aware ? batch.classes : torch::zeros_like(batch.classes);
    const torch::Tensor loss =
        network::DiscriminatorLoss(critic.network->forward(batch.follower, lengths),
                                   critic.network->forward(synthesised, lengths), classes);
    loss.backward();
    critic.optimiser->Step(step);
    if (settings_.unit_norm_kernels()) critic.network->NormaliseKernels();
    sum += loss.item<double>();
  }
  return sum;
}

torch::Tensor Adversary::GeneratorLoss(const TrainingBatch& batch,
                                       const torch::Tensor& synthesised) {
  torch::Tensor sum = torch::zeros({});
  if (batch.single_rows.numel() == 0) return sum;
  const torch::Tensor motion = synthesised.index_select(0, batch.single_rows);
  const torch::Tensor lengths = batch.input.lengths.index_select(0, batch.single_rows);
  const torch::Tensor classes = batch.classes.index_select(0, batch.single_rows);
  for (Critic& critic : critics_) {
    const Frozen frozen(*critic.network);
    sum = sum + network::AdversarialLoss(critic.network->forward(motion, lengths),
                                         critic.class_aware ? classes : torch::zeros_like(classes));
  }
  return sum;
}

std::vector<std::pair<std::string, torch::Tensor>> Adversary::Tensors() {
  std::vector<std::pair<std::string, torch::Tensor>> tensors;
  for (Critic& critic : critics_) {
    int64_t i = 0;
    for (const torch::Tensor& tensor : critic.network->parameters()) {
      tensors.emplace_back(absl::StrCat(critic.name, i++), tensor.detach());
    }
  }
  return tensors;
}

std::vector<std::pair<std::string, torch::optim::Optimizer*>> Adversary::Optimisers() {
  std::vector<std::pair<std::string, torch::optim::Optimizer*>> optimisers;
  for (Critic& critic : critics_) {
    optimisers.emplace_back(critic.name + "_optimiser", &critic.optimiser->state());
  }
  return optimisers;
}

}  // namespace duet::training
