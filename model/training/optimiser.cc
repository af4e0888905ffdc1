#include "model/training/optimiser.h"

#include <cmath>

#include "model/base/angle.h"

namespace duet::training {
namespace {

using base::kPi;
constexpr double kWarmUpShare = 0.2;
constexpr double kFirstFactor = 1.0 / 25;
constexpr double kLastFactor = 1e-5;
constexpr double kFirstMoment = 0.9;

double HalfCosine(double from, double to, double share) {
  return to + (from - to) * (1 + std::cos(kPi * share)) / 2;
}

// Matrices decay, biases and other vectors do not.
std::vector<torch::optim::OptimizerParamGroup> Groups(
    const std::vector<torch::Tensor>& parameters) {
  std::vector<torch::Tensor> matrices, vectors;
  for (const torch::Tensor& parameter : parameters) {
    (parameter.dim() >= 2 ? matrices : vectors).push_back(parameter);
  }
  std::vector<torch::optim::OptimizerParamGroup> groups;
  groups.emplace_back(matrices);
  groups.emplace_back(vectors);
  return groups;
}

std::unique_ptr<torch::optim::Optimizer> Make(const CommonSettings::Optimiser& options,
                                              const std::vector<torch::Tensor>& parameters) {
  if (options.name() == CommonSettings::Optimiser::RMSPROP) {
    return std::make_unique<torch::optim::RMSprop>(
        Groups(parameters),
        torch::optim::RMSpropOptions(options.learning_rate()).weight_decay(options.weight_decay()));
  }
  auto adam = std::make_unique<torch::optim::AdamW>(
      Groups(parameters), torch::optim::AdamWOptions(options.learning_rate())
                              .weight_decay(options.weight_decay())
                              .betas({kFirstMoment, options.second_moment()}));
  static_cast<torch::optim::AdamWOptions&>(adam->param_groups()[1].options()).weight_decay(0);
  return adam;
}

}  // namespace

double ScheduleFactor(const CommonSettings::Optimiser& options, int64_t step, int64_t steps) {
  if (options.schedule() == CONSTANT) return 1;
  const double share = static_cast<double>(step) / static_cast<double>(steps);
  if (options.schedule() == COSINE) {
    const double warm =
        step < options.warm_up_steps()
            ? static_cast<double>(step + 1) / static_cast<double>(options.warm_up_steps())
            : 1;
    return warm * HalfCosine(1, options.last_share(), share);
  }
  if (share < kWarmUpShare) return HalfCosine(kFirstFactor, 1, share / kWarmUpShare);
  return HalfCosine(1, kLastFactor, (share - kWarmUpShare) / (1 - kWarmUpShare));
}

Optimiser::Optimiser(const CommonSettings::Optimiser& options,
                     std::vector<torch::Tensor> parameters, int64_t steps)
    : options_(options),
      parameters_(std::move(parameters)),
      steps_(steps),
      optimiser_(Make(options, parameters_)) {}

void Optimiser::SetLearningRate(double rate) {
  for (torch::optim::OptimizerParamGroup& group : optimiser_->param_groups()) {
    group.options().set_lr(rate);
  }
}

void Optimiser::Step(int64_t step) {
  if (options_.gradient_clip() > 0) {
    torch::nn::utils::clip_grad_norm_(parameters_, options_.gradient_clip());
  }
  SetLearningRate(options_.learning_rate() * ScheduleFactor(options_, step, steps_));
  optimiser_->step();
  optimiser_->zero_grad();
}

}  // namespace duet::training
