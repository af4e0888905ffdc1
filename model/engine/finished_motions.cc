#include "model/engine/finished_motions.h"

#include <cstddef>
#include <memory>
#include <utility>

#include "model/engine/network_synthesizer.h"
#include "model/engine/window_standardisation.h"

namespace duet::engine {
namespace {

constexpr motion::StandardOrigin kOrigin = motion::StandardOrigin::kFirstFrame;

// A network that returns the same followers to every call.
class GivenFollowers : public Network {
 public:
  explicit GivenFollowers(std::vector<motion::Poses> followers)
      : followers_(std::move(followers)) {}
  absl::StatusOr<std::vector<motion::Poses>> Run(absl::Span<const NetworkInput>) const override {
    return followers_;
  }

 private:
  const std::vector<motion::Poses> followers_;
};

}  // namespace

std::vector<WindowResult> FinishMotions(const ModelDescription& description,
                                        const std::vector<SynthesisWindow>& windows,
                                        const std::vector<motion::Poses>& followers) {
  std::vector<motion::Poses> standard;
  std::vector<SynthesisWindow> copies = windows;
  std::vector<const SynthesisWindow*> pointers;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    standard.push_back(
        WindowStandardisation(description.skeleton, windows[i], kOrigin).Apply(followers[i]));
    copies[i].options.sampling.candidates = 1;
    pointers.push_back(&copies[i]);
  }
  return MakeSynthesizer(description, kOrigin,
                         std::make_unique<GivenFollowers>(std::move(standard)))
      ->Synthesize(pointers);
}

}  // namespace duet::engine
