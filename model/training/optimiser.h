#ifndef DUET_MODEL_TRAINING_OPTIMISER_H_
#define DUET_MODEL_TRAINING_OPTIMISER_H_

#include <torch/torch.h>

#include <memory>
#include <vector>

#include "model/training/options.h"

namespace duet::training {

// The learning rate at a step as a fraction of the maximum. "one_cycle" rises over the first fifth
// of the run from 1/25 and falls to almost 0, both along a half cosine (Smith, Topin 2018).
// "cosine" rises linearly over the warm-up steps and falls along a half cosine to last_share.
double ScheduleFactor(const CommonSettings::Optimiser& options, int64_t step, int64_t steps);

// Adam with decoupled weight decay of matrices, or RMSprop, on a schedule; clips gradients.
class Optimiser {
 public:
  Optimiser(const CommonSettings::Optimiser& options, std::vector<torch::Tensor> parameters,
            int64_t steps);

  // Applies the gradients of the parameters as step number `step` (from 0) and clears them.
  void Step(int64_t step);

  torch::optim::Optimizer& state() { return *optimiser_; }

 private:
  void SetLearningRate(double rate);

  CommonSettings::Optimiser options_;
  std::vector<torch::Tensor> parameters_;
  int64_t steps_;
  std::unique_ptr<torch::optim::Optimizer> optimiser_;
};

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_OPTIMISER_H_
