#include "model/network/torch_network.h"

#include <torch/torch.h>

#include <utility>
#include <variant>
#include <vector>

#include "model/checkpoint/architecture.h"
#include "model/network/batch.h"
#include "model/network/exceptions.h"
#include "model/network/flow_sampler.h"
#include "model/network/parameters.h"

namespace duet::network {
namespace {

// The module of each architecture, and its answer to a batch of windows. Without both functions, an
// architecture does not compile.
Generator ModuleOf(const checkpoint::PaperArchitecture&, const checkpoint::Manifest& manifest) {
  return Generator(manifest);
}
FlowGenerator ModuleOf(const checkpoint::FlowArchitecture&, const checkpoint::Manifest& manifest) {
  return FlowGenerator(manifest);
}
torch::Tensor Answer(const checkpoint::Manifest& manifest, Generator generator,
                     absl::Span<const engine::NetworkInput> inputs) {
  return generator->forward(MakeInput(manifest, inputs));
}
torch::Tensor Answer(const checkpoint::Manifest& manifest, const FlowGenerator& generator,
                     absl::Span<const engine::NetworkInput> inputs) {
  return AnswerWindows(generator, manifest, inputs);
}

template <typename AnyGenerator>
class TorchNetwork : public engine::Network {
 public:
  TorchNetwork(checkpoint::Manifest manifest, AnyGenerator generator)
      : manifest_(std::move(manifest)), generator_(std::move(generator)) {}

  absl::StatusOr<std::vector<motion::Poses>> Run(
      absl::Span<const engine::NetworkInput> inputs) const override {
    std::vector<motion::Poses> followers;
    absl::Status status = CatchExceptions([&] {
      const torch::NoGradGuard no_grad;
      followers = TakeAll(Answer(manifest_, generator_, inputs), inputs);
      return absl::OkStatus();
    });
    if (!status.ok()) return status;
    return followers;
  }

 private:
  const checkpoint::Manifest manifest_;
  const AnyGenerator generator_;  // a handle: running it changes nothing
};

}  // namespace

absl::StatusOr<std::unique_ptr<const engine::Network>> MakeTorchNetwork(
    const checkpoint::Checkpoint& checkpoint) {
  const checkpoint::Manifest& manifest = checkpoint.manifest;
  std::unique_ptr<const engine::Network> network;
  const auto make = [&](const auto& architecture) {
    auto generator = ModuleOf(architecture, manifest);
    absl::Status status = LoadParameters(checkpoint, generator);
    generator->eval();
    network = std::make_unique<const TorchNetwork<decltype(generator)>>(manifest, generator);
    return status;
  };
  absl::Status status = CatchExceptions([&] { return std::visit(make, manifest.architecture); });
  if (!status.ok()) return status;
  return network;
}

}  // namespace duet::network
