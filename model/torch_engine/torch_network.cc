#include "model/torch_engine/torch_network.h"

#include <torch/torch.h>

#include <cstddef>
#include <exception>
#include <functional>
#include <type_traits>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "model/network/batch.h"
#include "model/network/flow_sampler.h"
#include "model/network/parameters.h"

namespace duet::torch_engine {
namespace {

// Turns LibTorch's exceptions into a status.
absl::StatusOr<std::vector<motion::Poses>> Guarded(
    const std::function<std::vector<motion::Poses>()>& run) {
  try {
    torch::NoGradGuard no_grad;
    return run();
  } catch (const std::exception& error) {
    return absl::InternalError(absl::StrCat("the network failed: ", error.what()));
  }
}

torch::Tensor Answer(const checkpoint::Manifest& manifest, network::Generator generator,
                     absl::Span<const engine::NetworkInput> inputs) {
  return generator->forward(network::MakeInput(manifest, inputs));
}

torch::Tensor Answer(const checkpoint::Manifest& manifest, const network::FlowGenerator& generator,
                     absl::Span<const engine::NetworkInput> inputs) {
  return network::AnswerWindows(generator, manifest, inputs);
}

// The module that runs each architecture: its registration in this engine, together with its
// Answer above. Without a line here, an architecture does not compile.
template <typename Architecture>
struct GeneratorOf;
template <>
struct GeneratorOf<checkpoint::PaperArchitecture> {
  using Type = network::Generator;
};
template <>
struct GeneratorOf<checkpoint::FlowArchitecture> {
  using Type = network::FlowGenerator;
};

// A generator of any architecture, filled from a checkpoint.
template <typename AnyGenerator>
class TorchNetwork : public engine::Network {
 public:
  TorchNetwork(checkpoint::Manifest manifest, AnyGenerator generator)
      : manifest_(std::move(manifest)), generator_(std::move(generator)) {}

  absl::StatusOr<std::vector<motion::Poses>> Run(
      absl::Span<const engine::NetworkInput> inputs) const override {
    return Guarded([&] { return network::TakeAll(Answer(manifest_, generator_, inputs), inputs); });
  }

 private:
  const checkpoint::Manifest manifest_;
  const AnyGenerator generator_;  // a handle: running it changes nothing
};

template <typename AnyGenerator>
absl::StatusOr<std::unique_ptr<const engine::Network>> Make(
    const checkpoint::Checkpoint& checkpoint) {
  AnyGenerator generator(checkpoint.manifest);
  absl::Status status = network::LoadParameters(checkpoint, generator);
  if (!status.ok()) return status;
  generator->eval();
  return std::make_unique<const TorchNetwork<AnyGenerator>>(checkpoint.manifest,
                                                            std::move(generator));
}

}  // namespace

absl::StatusOr<std::unique_ptr<const engine::Network>> MakeTorchNetwork(
    const checkpoint::Checkpoint& checkpoint) {
  // LibTorch throws both here and in Run.
  try {
    return std::visit(
        [&checkpoint](const auto& architecture) {
          return Make<typename GeneratorOf<std::decay_t<decltype(architecture)>>::Type>(checkpoint);
        },
        checkpoint.manifest.architecture);
  } catch (const std::exception& error) {
    return absl::InternalError(absl::StrCat("the network cannot be made: ", error.what()));
  }
}

}  // namespace duet::torch_engine
