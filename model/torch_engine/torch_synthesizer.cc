#include "model/torch_engine/torch_synthesizer.h"

#include <torch/torch.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/checkpoints/embedded.h"
#include "model/engine/window_frame.h"
#include "model/motion/limb_lengths.h"
#include "model/network/batch.h"
#include "model/network/parameters.h"

namespace duet::torch_engine {
namespace {

class TorchSynthesizer : public engine::Synthesizer {
 public:
  TorchSynthesizer(checkpoint::Manifest manifest, network::Generator generator,
                   const TorchSynthesizerOptions& options)
      : manifest_(std::move(manifest)), generator_(std::move(generator)), options_(options) {}

  const engine::ModelDescription& description() const override { return manifest_.model; }

  std::vector<engine::WindowResult> Synthesize(
      absl::Span<const engine::SynthesisWindow* const> windows) const override {
    if (windows.empty()) return {};
    // LibTorch reports by exception: this is where they stop.
    try {
      return Run(windows);
    } catch (const std::exception& error) {
      return std::vector<engine::WindowResult>(
          windows.size(), absl::InternalError(absl::StrCat("the network failed: ", error.what())));
    }
  }

 private:
  std::vector<engine::WindowResult> Run(
      absl::Span<const engine::SynthesisWindow* const> windows) const {
    torch::NoGradGuard no_grad;
    std::vector<motion::Standardisation> standards;
    std::vector<network::BatchItem> items;
    for (const engine::SynthesisWindow* window : windows) {
      standards.push_back(WindowFrame(manifest_.model.skeleton, *window, OriginOf(manifest_)));
      items.push_back(network::StandardItem(standards.back(), *window));
    }
    const torch::Tensor followers = generator_->forward(network::MakeInput(manifest_, items));
    std::vector<engine::WindowResult> results;
    for (size_t n = 0; n < windows.size(); ++n) {
      results.push_back(Take(followers, n, *windows[n], standards[n]));
    }
    return results;
  }

  engine::WindowResult Take(const torch::Tensor& followers, size_t clip,
                            const engine::SynthesisWindow& window,
                            const motion::Standardisation& standard) const {
    const motion::Skeleton& skeleton = manifest_.model.skeleton;
    const int64_t frames = static_cast<int64_t>(window.leader.size()) / skeleton.joint_count();
    std::vector<motion::Vec3> follower =
        standard.Invert(network::TakePositions(followers, static_cast<int64_t>(clip), frames));
    for (const motion::Vec3& point : follower) {
      if (!IsFinite(point)) return absl::InternalError("the network's result is not finite");
    }
    if (options_.keep_limb_lengths) KeepLimbLengths(window, &follower);
    if (options_.share_floor && !window.start) ShareFloor(window.leader, &follower);
    return follower;
  }

  void KeepLimbLengths(const engine::SynthesisWindow& window,
                       std::vector<motion::Vec3>* follower) const {
    const motion::Skeleton& skeleton = manifest_.model.skeleton;
    const bool has_pose = window.start && !window.start->pose.empty();
    const std::vector<motion::Vec3>& owner = has_pose ? window.start->pose : window.leader;
    SetBoneLengths(skeleton, MedianBoneLengths(skeleton, owner), follower);
  }

  void ShareFloor(const std::vector<motion::Vec3>& leader,
                  std::vector<motion::Vec3>* follower) const {
    const motion::Vec3 lift{0, LowestFoot(leader) - LowestFoot(*follower), 0};
    for (motion::Vec3& point : *follower) point += lift;
  }

  float LowestFoot(const std::vector<motion::Vec3>& positions) const {
    const motion::Skeleton& skeleton = manifest_.model.skeleton;
    float lowest = std::numeric_limits<float>::infinity();
    for (size_t t = 0; t < positions.size(); t += skeleton.joint_names.size()) {
      for (const int foot : {skeleton.left_foot, skeleton.right_foot}) {
        lowest = std::min(lowest, positions[t + static_cast<size_t>(foot)].y);
      }
    }
    return lowest;
  }

  checkpoint::Manifest manifest_;
  mutable network::Generator generator_;  // forward is not const; it changes nothing
  TorchSynthesizerOptions options_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<engine::Synthesizer>> MakeTorchSynthesizer(
    const checkpoint::Checkpoint& checkpoint, const TorchSynthesizerOptions& options) {
  network::Generator generator(checkpoint.manifest);
  absl::Status status = network::LoadParameters(checkpoint, generator);
  if (!status.ok()) return status;
  generator->eval();
  return std::make_unique<TorchSynthesizer>(checkpoint.manifest, std::move(generator), options);
}

absl::StatusOr<std::unique_ptr<engine::Synthesizer>> LoadTorchSynthesizer(
    const std::filesystem::path& folder, const TorchSynthesizerOptions& options) {
  absl::StatusOr<checkpoint::Checkpoint> checkpoint = checkpoint::ReadCheckpoint(folder);
  if (!checkpoint.ok()) return checkpoint.status();
  return MakeTorchSynthesizer(*checkpoint, options);
}

absl::StatusOr<std::vector<std::unique_ptr<engine::Synthesizer>>> LoadEmbeddedSynthesizers(
    const TorchSynthesizerOptions& options) {
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

void SetTorchThreads(int threads) {
  torch::set_num_threads(threads);
  // LibTorch lets this one be set only once.
  if (torch::get_num_interop_threads() != 1) torch::set_num_interop_threads(1);
}

}  // namespace duet::torch_engine
