#include "model/engine/network_synthesizer.h"

#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/engine/finishing.h"
#include "model/engine/standard_window.h"
#include "model/engine/unfamiliarity.h"
#include "model/engine/window_standardisation.h"

namespace duet::engine {
namespace {

using Windows = absl::Span<const SynthesisWindow* const>;

class NetworkSynthesizer : public Synthesizer {
 public:
  NetworkSynthesizer(ModelDescription description, motion::StandardOrigin origin,
                     std::unique_ptr<const Network> network, const PipelineOptions& options)
      : description_(std::move(description)),
        origin_(origin),
        network_(std::move(network)),
        options_(options),
        clean_up_(description_.skeleton, options.cleaning) {}

  const ModelDescription& description() const override { return description_; }

  std::vector<WindowResult> Synthesize(Windows windows) const override {
    if (windows.empty()) return {};
    std::vector<motion::Standardisation> standardisations;
    std::vector<NetworkInput> inputs;
    for (const SynthesisWindow* window : windows) {
      standardisations.push_back(WindowStandardisation(description_.skeleton, *window, origin_));
      inputs.push_back(Standardise(standardisations.back(), *window));
    }
    const absl::StatusOr<std::vector<motion::Poses>> followers = RunNetwork(inputs);
    if (!followers.ok()) return {windows.size(), followers.status()};
    std::vector<WindowResult> results;
    for (std::size_t i = 0; i < windows.size(); ++i) {
      results.push_back(IsCancelled(inputs[i])
                            ? absl::CancelledError("cancelled while it was being answered")
                            : Finish(*windows[i], standardisations[i], (*followers)[i]));
    }
    return results;
  }

  std::optional<double> Unfamiliarity(const ClipRequest& request) const override {
    return engine::Unfamiliarity(description_, request);
  }

 private:
  // Going on with an answer of another shape would read past it.
  absl::StatusOr<std::vector<motion::Poses>> RunNetwork(
      const std::vector<NetworkInput>& inputs) const {
    absl::StatusOr<std::vector<motion::Poses>> followers = network_->Run(inputs);
    if (!followers.ok()) return followers;
    if (followers->size() != inputs.size()) {
      return absl::InternalError(absl::StrCat("the network answered ", followers->size(),
                                              " windows, expected ", inputs.size()));
    }
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const motion::Poses &leader = inputs[i].leader, &follower = (*followers)[i];
      if (follower.frame_count() == leader.frame_count() &&
          follower.joint_count() == leader.joint_count()) {
        continue;
      }
      return absl::InternalError(absl::StrCat(
          "the network answered ", follower.frame_count(), " frames of ", follower.joint_count(),
          " joints, expected ", leader.frame_count(), " of ", leader.joint_count()));
    }
    return followers;
  }

  WindowResult Finish(const SynthesisWindow& window, const motion::Standardisation& standardisation,
                      const motion::Poses& standard) const {
    motion::Poses follower = standardisation.Invert(standard);
    if (absl::Status status = CheckFinite(follower); !status.ok()) return status;
    if (options_.keep_limb_lengths) KeepLimbLengths(description_.skeleton, window, &follower);
    if (options_.share_floor) ShareFloor(description_.skeleton, window, &follower);
    if (IsCleanedUp(window)) {
      clean_up_.Apply(window.leader, TouchOf(description_, window),
                      {description_.frame_rate_hz, SettledFrames(window)}, &follower);
    }
    return follower;
  }

  bool IsCleanedUp(const SynthesisWindow& window) const {
    return window.options.clean_up.value_or(options_.clean_up &&
                                            description_.cleaned_up_by_default());
  }

  const ModelDescription description_;
  const motion::StandardOrigin origin_;
  const std::unique_ptr<const Network> network_;
  const PipelineOptions options_;
  const cleanup::CleanUp clean_up_;
};

}  // namespace

std::unique_ptr<Synthesizer> MakeSynthesizer(ModelDescription description,
                                             motion::StandardOrigin origin,
                                             std::unique_ptr<const Network> network,
                                             const PipelineOptions& options) {
  return std::make_unique<NetworkSynthesizer>(std::move(description), origin, std::move(network),
                                              options);
}

}  // namespace duet::engine
