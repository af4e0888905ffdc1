#include "model/evaluation/experiments/synthesizer_method.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/engine/clip_synthesis.h"
#include "model/evaluation/experiments/live_clip.h"

namespace duet::evaluation::experiments {
namespace {

// Bounds the memory of one evaluation; beyond it batches gain little.
constexpr size_t kClipsTogether = 64;

engine::ClipRequest MakeRequest(const motion::Skeleton& skeleton, const LabelledLeader& labelled,
                                StartGiven start) {
  const dataset::Sequence& sequence = *labelled.sequence;
  const motion::Clip& leader = sequence.pair.leader;
  const motion::Clip& follower = sequence.pair.follower;
  engine::ClipRequest request{leader.poses, leader.frame_rate_hz,       labelled.labels,
                              std::nullopt, sequence.partner_direction, {labelled.sampling, {}}};
  if (!labelled.tell_direction) request.partner_direction.reset();
  if (start == StartGiven::kNone) return request;
  request.start = engine::FollowerStart{follower.at(0, skeleton.root), {}};
  if (start == StartGiven::kPose) {
    request.start->pose.assign(follower.poses[0].begin(), follower.poses[0].end());
  }
  return request;
}

using AnyClip = std::variant<engine::ClipSynthesis, LiveClip>;

AnyClip MakeClip(const engine::ModelDescription& model, const LabelledLeader& leader,
                 StartGiven start) {
  engine::ClipRequest request = MakeRequest(model.skeleton, leader, start);
  if (!leader.live_delay) return engine::ClipSynthesis(model, std::move(request));
  return LiveClip(model, std::move(request), *leader.live_delay);
}

bool HasNextWindow(const AnyClip& clip) {
  return std::visit([](const auto& any) { return any.HasNextWindow(); }, clip);
}

// Evaluates the next window of every clip that is not finished, all together.
absl::Status NextWindows(const engine::Synthesizer& synthesizer, std::vector<AnyClip>* clips,
                         std::vector<motion::Poses>* followers) {
  std::vector<size_t> waiting;
  std::vector<engine::SynthesisWindow> windows;
  for (size_t i = 0; i < clips->size(); ++i) {
    if (!HasNextWindow((*clips)[i])) continue;
    waiting.push_back(i);
    windows.push_back(std::visit([](auto& clip) { return clip.NextWindow(); }, (*clips)[i]));
  }
  std::vector<const engine::SynthesisWindow*> pointers;
  pointers.reserve(windows.size());
  for (const engine::SynthesisWindow& window : windows) pointers.push_back(&window);
  const std::vector<engine::WindowResult> results = synthesizer.Synthesize(pointers);
  for (size_t n = 0; n < waiting.size(); ++n) {
    if (!results[n].ok()) return results[n].status();
    const motion::Poses frames =
        std::visit([&](auto& clip) { return clip.Accept(*results[n]); }, (*clips)[waiting[n]]);
    (*followers)[waiting[n]].Append(frames.all());
  }
  return absl::OkStatus();
}

absl::Status SynthesizeTogether(const engine::Synthesizer& synthesizer,
                                absl::Span<const LabelledLeader> leaders, StartGiven start,
                                std::vector<motion::Poses>* followers) {
  const engine::ModelDescription& model = synthesizer.description();
  for (const LabelledLeader& leader : leaders) {
    if (!leader.live_delay || engine::AnswersLive(model)) continue;
    return absl::FailedPreconditionError(
        absl::StrCat("model ", model.name, ": does not answer live"));
  }
  std::vector<AnyClip> clips;
  for (const LabelledLeader& leader : leaders) clips.push_back(MakeClip(model, leader, start));
  std::vector<motion::Poses> made(clips.size(), motion::Poses(0, model.skeleton.joint_count()));
  while (std::any_of(clips.begin(), clips.end(), HasNextWindow)) {
    absl::Status status = NextWindows(synthesizer, &clips, &made);
    if (!status.ok()) return status;
  }
  std::move(made.begin(), made.end(), std::back_inserter(*followers));
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckModelFits(const engine::ModelDescription& model,
                            const dataset::Dataset& dataset) {
  if (model.classes != dataset.classes) {
    return absl::FailedPreconditionError(
        absl::StrCat("model ", model.name, ": its classes are ", absl::StrJoin(model.classes, ", "),
                     ", the data's ", absl::StrJoin(dataset.classes, ", ")));
  }
  if (model.skeleton.joint_names != dataset.skeleton.joint_names) {
    return absl::FailedPreconditionError(
        absl::StrCat("model ", model.name, ": its joints are not the data's"));
  }
  return absl::OkStatus();
}

absl::Status CheckModelTakes(const engine::ModelDescription& model, const dataset::Dataset& dataset,
                             StartGiven start) {
  absl::Status status = CheckModelFits(model, dataset);
  if (!status.ok()) return status;
  if (start != StartGiven::kNone && !model.accepts_follower_start) {
    return absl::FailedPreconditionError(
        absl::StrCat("model ", model.name, ": does not accept a follower start"));
  }
  return absl::OkStatus();
}

absl::StatusOr<motion::Poses> SynthesizeSequence(const engine::Synthesizer& synthesizer,
                                                 const dataset::Sequence& sequence,
                                                 const std::vector<float>& labels,
                                                 StartGiven start) {
  const LabelledLeader leader = {&sequence, engine::LabelTrack(labels)};
  absl::StatusOr<std::vector<motion::Poses>> followers =
      SynthesizeSequences(synthesizer, {&leader, 1}, start);
  if (!followers.ok()) return followers.status();
  return std::move(followers->front());
}

std::vector<float> OneClass(int classes, int interaction_class) {
  std::vector<float> weights(static_cast<size_t>(classes));
  weights[static_cast<size_t>(interaction_class)] = 1;
  return weights;
}

engine::LabelTrack TimeLineLabels(const dataset::Sequence& sequence, int classes) {
  const auto at = [&](int frame) {
    std::vector<float> weights(static_cast<size_t>(classes));
    for (const dataset::LabelSpan& span : sequence.labels) {
      if (span.begin > frame || frame >= span.end) continue;
      weights[static_cast<size_t>(span.interaction_class)] = 1;
    }
    return weights;
  };
  std::set<int> frames = {0};
  for (const dataset::LabelSpan& span : sequence.labels) {
    // Both sides of an edge, because weights are linear between key frames.
    for (const int edge : {span.begin, span.end}) {
      if (edge > 0) frames.insert({edge - 1, edge});
    }
  }
  std::vector<engine::LabelKeyframe> keyframes;
  keyframes.reserve(frames.size());
  for (const int frame : frames) keyframes.push_back({frame, at(frame)});
  return engine::LabelTrack(std::move(keyframes));
}

absl::StatusOr<std::vector<motion::Poses>> SynthesizeSequences(
    const engine::Synthesizer& synthesizer, absl::Span<const LabelledLeader> leaders,
    StartGiven start) {
  std::vector<motion::Poses> followers;
  for (size_t first = 0; first < leaders.size(); first += kClipsTogether) {
    absl::Status status =
        SynthesizeTogether(synthesizer, leaders.subspan(first, kClipsTogether), start, &followers);
    if (!status.ok()) return status;
  }
  return followers;
}

SynthesizerMethod::SynthesizerMethod(std::string name,
                                     std::shared_ptr<const engine::Synthesizer> synthesizer,
                                     StartGiven start)
    : name_(std::move(name)), synthesizer_(std::move(synthesizer)), start_(start) {}

absl::Status SynthesizerMethod::Train(const dataset::Dataset& dataset, const std::vector<int>&) {
  return CheckModelTakes(synthesizer_->description(), dataset, start_);
}

absl::StatusOr<motion::Poses> SynthesizerMethod::Predict(const dataset::Sequence& sequence) const {
  return SynthesizeSequence(
      *synthesizer_, sequence,
      OneClass(synthesizer_->description().class_count(), sequence.interaction_class), start_);
}

}  // namespace duet::evaluation::experiments
