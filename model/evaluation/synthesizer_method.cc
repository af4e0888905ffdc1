#include "model/evaluation/synthesizer_method.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/engine/clip_synthesis.h"

namespace duet {
namespace {

ClipRequest MakeRequest(const Skeleton& skeleton, const Sequence& sequence,
                        const std::vector<float>& labels, StartGiven start) {
  const Clip& leader = sequence.pair.leader;
  const Clip& follower = sequence.pair.follower;
  ClipRequest request{leader.positions, leader.frame_rate_hz, LabelTrack(labels), std::nullopt,
                      sequence.partner_direction};
  if (start == StartGiven::kNone) return request;
  request.start = FollowerStart{follower.at(0, skeleton.root), {}};
  if (start == StartGiven::kPose) {
    request.start->pose.assign(follower.frame(0), follower.frame(0) + skeleton.joint_count());
  }
  return request;
}

}  // namespace

absl::StatusOr<std::vector<Vec3>> SynthesizeSequence(const Synthesizer& synthesizer,
                                                     const Sequence& sequence,
                                                     const std::vector<float>& labels,
                                                     StartGiven start) {
  const ModelDescription& model = synthesizer.description();
  ClipSynthesis clip(model, MakeRequest(model.skeleton, sequence, labels, start));
  std::vector<Vec3> follower;
  while (clip.HasNextWindow()) {
    const SynthesisWindow window = clip.NextWindow();
    const SynthesisWindow* const one = &window;
    const WindowResult result = synthesizer.Synthesize({&one, 1}).front();
    if (!result.ok()) return result.status();
    const std::vector<Vec3> frames = clip.Accept(*result);
    follower.insert(follower.end(), frames.begin(), frames.end());
  }
  return follower;
}

SynthesizerMethod::SynthesizerMethod(std::string name,
                                     std::shared_ptr<const Synthesizer> synthesizer,
                                     StartGiven start)
    : name_(std::move(name)), synthesizer_(std::move(synthesizer)), start_(start) {}

absl::Status SynthesizerMethod::Train(const Dataset& dataset, const std::vector<int>&) {
  const ModelDescription& model = synthesizer_->description();
  if (model.classes != dataset.classes) {
    return absl::FailedPreconditionError(
        absl::StrCat("model ", model.name, ": its classes are ", absl::StrJoin(model.classes, ", "),
                     ", the data's ", absl::StrJoin(dataset.classes, ", ")));
  }
  if (model.skeleton.joint_names != dataset.skeleton.joint_names) {
    return absl::FailedPreconditionError(
        absl::StrCat("model ", model.name, ": its joints are not the data's"));
  }
  if (start_ != StartGiven::kNone && !model.accepts_follower_start) {
    return absl::FailedPreconditionError(
        absl::StrCat("model ", model.name, ": does not accept a follower start"));
  }
  return absl::OkStatus();
}

std::vector<Vec3> SynthesizerMethod::Predict(const Sequence& sequence) const {
  std::vector<float> labels(synthesizer_->description().classes.size(), 0);
  labels[static_cast<size_t>(sequence.interaction_class)] = 1;
  absl::StatusOr<std::vector<Vec3>> follower =
      SynthesizeSequence(*synthesizer_, sequence, labels, start_);
  return follower.ok() ? *std::move(follower) : std::vector<Vec3>{};
}

}  // namespace duet
