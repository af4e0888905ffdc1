#ifndef DUET_MODEL_TRAINING_LOSS_MEANS_H_
#define DUET_MODEL_TRAINING_LOSS_MEANS_H_

#include <torch/torch.h>

#include <cstdint>
#include <utility>
#include <vector>

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

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_LOSS_MEANS_H_
