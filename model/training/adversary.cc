#include "model/training/adversary.h"

#include "absl/strings/str_cat.h"
#include "model/network/losses.h"

namespace duet::training {
namespace {

TrainingOptions::Optimiser OptimiserOptions(const TrainingOptions& options) {
  TrainingOptions::Optimiser optimiser = options.optimiser;
  optimiser.learning_rate = std::get<PaperTraining>(options.method).discriminator.learning_rate;
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
    : options_(options), settings_(std::get<PaperTraining>(options.method).discriminator) {
  Add("discriminator", true, manifest, steps);
  if (settings_.binary) Add("binary_discriminator", false, manifest, steps);
}

void Adversary::Add(const std::string& name, bool class_aware, const checkpoint::Manifest& manifest,
                    int64_t steps) {
  network::DiscriminatorOptions sizes;
  sizes.input = 3 * manifest.model.skeleton.joint_count();
  sizes.window_frames = manifest.model.window_frames;
  sizes.hidden = settings_.hidden;
  sizes.outputs = class_aware ? manifest.model.class_count() + 1 : 2;
  network::Discriminator network(sizes);
  network->set_dropout(settings_.dropout);
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
    if (settings_.unit_norm_kernels) critic.network->NormaliseKernels();
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
