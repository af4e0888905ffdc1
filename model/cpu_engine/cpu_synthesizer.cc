#include "model/cpu_engine/cpu_synthesizer.h"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <variant>

#include "model/checkpoint/architecture.h"
#include "model/cpu_engine/flow_network.h"
#include "model/cpu_engine/kernels/gemm.h"
#include "model/cpu_engine/paper_network.h"
#include "model/cpu_engine/scratch.h"
#include "model/embedded/embedded.h"

namespace duet::cpu_engine {
namespace {

// Frames that are evaluated together: 16 windows of 45. More are no faster, because their values no
// longer fit in the caches.
constexpr int kFramesAtOnce = 720;

Scratch& ThreadScratch() {
  thread_local Scratch scratch;
  return scratch;
}

// Number of inputs that are evaluated together, at least one.
std::size_t TakeTogether(absl::Span<const engine::NetworkInput> inputs) {
  int frames = 0;
  std::size_t count = 0;
  for (; count < inputs.size(); ++count) {
    frames += inputs[count].leader.frame_count();
    if (count > 0 && frames > kFramesAtOnce) break;
  }
  return count;
}

// The class that runs each architecture: its registration in this engine. Without a line here, an
// architecture does not compile.
template <typename Architecture>
struct GeneratorOf;
template <>
struct GeneratorOf<checkpoint::PaperArchitecture> {
  using Type = PaperNetwork;
};
template <>
struct GeneratorOf<checkpoint::FlowArchitecture> {
  using Type = FlowNetwork;
};

template <typename Generator>
class CpuNetwork : public engine::Network {
 public:
  CpuNetwork(const checkpoint::Checkpoint& checkpoint, kernels::Precision precision)
      : generator_(checkpoint, precision) {}

  absl::StatusOr<std::vector<motion::Poses>> Run(
      absl::Span<const engine::NetworkInput> inputs) const override {
    std::vector<motion::Poses> followers;
    followers.reserve(inputs.size());
    for (const engine::NetworkInput& input : inputs) {
      followers.emplace_back(input.leader.frame_count(), input.leader.joint_count());
    }
    for (std::size_t first = 0; first < inputs.size();) {
      const std::size_t count = TakeTogether(inputs.subspan(first));
      Scratch::Use scratch(&ThreadScratch());
      generator_.Run(inputs.subspan(first, count), &scratch,
                     absl::MakeSpan(followers).subspan(first, count));
      first += count;
    }
    return followers;
  }

 private:
  const Generator generator_;
};

}  // namespace

kernels::Precision BestPrecision() {
  return kernels::IsInt16Faster() ? kernels::Precision::kInt16 : kernels::Precision::kFloat32;
}

std::unique_ptr<const engine::Network> MakeCpuNetwork(const checkpoint::Checkpoint& checkpoint,
                                                      kernels::Precision precision) {
  return std::visit(
      [&](const auto& architecture) -> std::unique_ptr<const engine::Network> {
        using Generator = typename GeneratorOf<std::decay_t<decltype(architecture)>>::Type;
        return std::make_unique<const CpuNetwork<Generator>>(checkpoint, precision);
      },
      checkpoint.manifest.architecture);
}

std::size_t ThreadScratchBytes() { return ThreadScratch().bytes(); }

std::unique_ptr<engine::Synthesizer> MakeCpuSynthesizer(const checkpoint::Checkpoint& checkpoint,
                                                        const CpuEngineOptions& options) {
  return MakeSynthesizer(checkpoint.manifest.model, checkpoint.manifest.standardisation,
                         MakeCpuNetwork(checkpoint, options.precision), options.as_served,
                         checkpoint::CriticOf(checkpoint));
}

absl::StatusOr<std::unique_ptr<engine::Synthesizer>> LoadCpuSynthesizer(
    const std::filesystem::path& folder, const CpuEngineOptions& options) {
  absl::StatusOr<checkpoint::Checkpoint> checkpoint = checkpoint::ReadCheckpoint(folder);
  if (!checkpoint.ok()) return checkpoint.status();
  return MakeCpuSynthesizer(*checkpoint, options);
}

absl::StatusOr<std::vector<std::unique_ptr<engine::Synthesizer>>> LoadEmbeddedSynthesizers(
    const CpuEngineOptions& options) {
  std::vector<std::unique_ptr<engine::Synthesizer>> synthesizers;
  for (const embedded::EmbeddedCheckpoint& embedded : embedded::EmbeddedCheckpoints()) {
    absl::StatusOr<checkpoint::Checkpoint> checkpoint =
        checkpoint::ParseCheckpoint(embedded.manifest, embedded.weights);
    if (!checkpoint.ok()) return checkpoint.status();
    synthesizers.push_back(MakeCpuSynthesizer(*checkpoint, options));
  }
  return synthesizers;
}

}  // namespace duet::cpu_engine
