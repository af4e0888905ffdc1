#include "model/torch_engine/torch_network.h"

#include <torch/torch.h>

#include <cstddef>
#include <exception>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/network/batch.h"
#include "model/network/parameters.h"

namespace duet::torch_engine {
namespace {

class TorchNetwork : public engine::Network {
 public:
  TorchNetwork(checkpoint::Manifest manifest, network::Generator generator)
      : manifest_(std::move(manifest)), generator_(std::move(generator)) {}

  absl::StatusOr<std::vector<motion::Poses>> Run(
      absl::Span<const engine::NetworkInput> inputs) const override {
    // LibTorch reports by exception: this is where they stop.
    try {
      return Forward(inputs);
    } catch (const std::exception& error) {
      return absl::InternalError(absl::StrCat("the network failed: ", error.what()));
    }
  }

 private:
  std::vector<motion::Poses> Forward(absl::Span<const engine::NetworkInput> inputs) const {
    torch::NoGradGuard no_grad;
    const torch::Tensor batch = generator_->forward(network::MakeInput(manifest_, inputs));
    std::vector<motion::Poses> followers;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      followers.push_back(
          network::TakePoses(batch, static_cast<int64_t>(i), inputs[i].leader.frame_count()));
    }
    return followers;
  }

  const checkpoint::Manifest manifest_;
  mutable network::Generator generator_;  // forward is not const; it changes nothing
};

}  // namespace

absl::StatusOr<std::unique_ptr<const engine::Network>> MakeTorchNetwork(
    const checkpoint::Checkpoint& checkpoint) {
  // LibTorch reports by exception: here they stop while loading, in Run while answering.
  try {
    network::Generator generator(checkpoint.manifest);
    absl::Status status = network::LoadParameters(checkpoint, generator);
    if (!status.ok()) return status;
    generator->eval();
    return std::make_unique<const TorchNetwork>(checkpoint.manifest, std::move(generator));
  } catch (const std::exception& error) {
    return absl::InternalError(absl::StrCat("the network cannot be made: ", error.what()));
  }
}

}  // namespace duet::torch_engine
