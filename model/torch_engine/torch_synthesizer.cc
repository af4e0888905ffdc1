#include "model/torch_engine/torch_synthesizer.h"

#include <torch/torch.h>

#include <exception>
#include <functional>
#include <type_traits>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "model/checkpoint/architecture.h"
#include "model/embedded/embedded.h"
#include "model/network/batch.h"
#include "model/network/exceptions.h"
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

absl::StatusOr<std::unique_ptr<engine::Synthesizer>> MakeTorchSynthesizer(
    const checkpoint::Checkpoint& checkpoint, const engine::PipelineOptions& options) {
  absl::StatusOr<std::unique_ptr<const engine::Network>> network = MakeTorchNetwork(checkpoint);
  if (!network.ok()) return network.status();
  const checkpoint::Manifest& manifest = checkpoint.manifest;
  return MakeSynthesizer(manifest.model, manifest.standardisation, *std::move(network), options,
                         checkpoint::CriticOf(checkpoint));
}

absl::StatusOr<std::unique_ptr<engine::Synthesizer>> LoadTorchSynthesizer(
    const std::filesystem::path& folder, const engine::PipelineOptions& options) {
  absl::StatusOr<checkpoint::Checkpoint> checkpoint = checkpoint::ReadCheckpoint(folder);
  if (!checkpoint.ok()) return checkpoint.status();
  return MakeTorchSynthesizer(*checkpoint, options);
}

absl::StatusOr<std::vector<std::unique_ptr<engine::Synthesizer>>> LoadEmbeddedSynthesizers(
    const engine::PipelineOptions& options) {
  std::vector<std::unique_ptr<engine::Synthesizer>> synthesizers;
  for (const embedded::EmbeddedCheckpoint& embedded : embedded::EmbeddedCheckpoints()) {
    absl::StatusOr<checkpoint::Checkpoint> checkpoint =
        checkpoint::ParseCheckpoint(embedded.manifest, embedded.weights);
    if (!checkpoint.ok()) return checkpoint.status();
    absl::StatusOr<std::unique_ptr<engine::Synthesizer>> synthesizer =
        MakeTorchSynthesizer(*checkpoint, options);
    if (!synthesizer.ok()) return synthesizer.status();
    synthesizers.push_back(*std::move(synthesizer));
  }
  return synthesizers;
}

absl::Status SetTorchThreads(int threads) {
  absl::Status status = network::SetThreads(threads);
  if (!status.ok()) return status;
  return network::CatchExceptions([] {
    // LibTorch allows setting this only once.
    if (torch::get_num_interop_threads() != 1) torch::set_num_interop_threads(1);
    return absl::OkStatus();
  });
}

}  // namespace duet::torch_engine
