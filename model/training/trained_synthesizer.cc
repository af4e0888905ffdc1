#include "model/training/trained_synthesizer.h"

#include <torch/torch.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "model/engine/network_synthesizer.h"
#include "model/network/batch.h"
#include "model/network/flow_generator.h"
#include "model/network/flow_sampler.h"
#include "model/network/parameters.h"

namespace duet::training {
namespace {

constexpr std::size_t kWindowsTogether = 64;

// The generator as the engine sees it.
class GeneratorNetwork : public engine::Network {
 public:
  explicit GeneratorNetwork(const checkpoint::Checkpoint& checkpoint)
      : manifest_(checkpoint.manifest), generator_(checkpoint.manifest) {
    loaded_ = network::LoadParameters(checkpoint, generator_);
    generator_->eval();
  }
  const absl::Status& loaded() const { return loaded_; }

  absl::StatusOr<std::vector<motion::Poses>> Run(
      absl::Span<const engine::NetworkInput> inputs) const override {
    const torch::NoGradGuard no_grad;
    return network::TakeAll(network::AnswerWindows(generator_, manifest_, inputs), inputs);
  }

 private:
  const checkpoint::Manifest& manifest_;
  network::FlowGenerator generator_;
  absl::Status loaded_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<engine::Synthesizer>> SynthesizerOf(
    const checkpoint::Checkpoint& checkpoint) {
  auto network = std::make_unique<GeneratorNetwork>(checkpoint);
  if (!network->loaded().ok()) return network->loaded();
  return MakeSynthesizer(checkpoint.manifest.model, checkpoint.manifest.standardisation,
                         std::move(network));
}

std::vector<engine::WindowResult> AnswerAll(const engine::Synthesizer& synthesizer,
                                            const std::vector<engine::SynthesisWindow>& windows) {
  std::vector<engine::WindowResult> answers;
  for (std::size_t first = 0; first < windows.size(); first += kWindowsTogether) {
    std::vector<const engine::SynthesisWindow*> some;
    for (std::size_t i = first; i < std::min(first + kWindowsTogether, windows.size()); ++i) {
      some.push_back(&windows[i]);
    }
    for (engine::WindowResult& answer : synthesizer.Synthesize(some)) {
      answers.push_back(std::move(answer));
    }
  }
  return answers;
}

}  // namespace duet::training
