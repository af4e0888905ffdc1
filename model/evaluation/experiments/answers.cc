#include "model/evaluation/experiments/answers.h"

#include <cstddef>
#include <iterator>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/status_macros.h"
#include "model/engine/clip_synthesis.h"
#include "model/engine/clips_together.h"
#include "model/engine/live_clip.h"

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

// Answers leaders together, as clips of either kind.
template <typename Clip, typename... Delay>
absl::StatusOr<std::vector<motion::Poses>> SynthesizeAs(const engine::Synthesizer& synthesizer,
                                                        absl::Span<const LabelledLeader> leaders,
                                                        StartGiven start, Delay... delay) {
  const engine::ModelDescription& model = synthesizer.description();
  std::vector<Clip> clips;
  for (const LabelledLeader& leader : leaders) {
    clips.emplace_back(model, MakeRequest(model.skeleton, leader, start), delay...);
  }
  return engine::SynthesizeTogether(synthesizer, &clips);
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
  DUET_RETURN_IF_ERROR(CheckModelFits(model, dataset));
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
  DUET_TRY(auto followers, SynthesizeSequences(synthesizer, {&leader, 1}, start));
  return std::move(followers.front());
}

std::vector<float> OneClass(int classes, int interaction_class) {
  std::vector<float> weights(static_cast<size_t>(classes));
  weights[static_cast<size_t>(interaction_class)] = 1;
  return weights;
}

absl::StatusOr<std::vector<motion::Poses>> SynthesizeSequences(
    const engine::Synthesizer& synthesizer, absl::Span<const LabelledLeader> leaders,
    StartGiven start) {
  std::vector<motion::Poses> followers;
  if (leaders.empty()) return followers;
  const std::optional<int> delay = leaders.front().live_delay;
  if (delay && !engine::AnswersLive(synthesizer.description())) {
    return absl::FailedPreconditionError(
        absl::StrCat("model ", synthesizer.description().name, ": does not answer live"));
  }
  for (size_t first = 0; first < leaders.size(); first += kClipsTogether) {
    const auto some = leaders.subspan(first, kClipsTogether);
    DUET_TRY(std::vector<motion::Poses> more,
             delay ? SynthesizeAs<engine::LiveClip>(synthesizer, some, start, *delay)
                   : SynthesizeAs<engine::ClipSynthesis>(synthesizer, some, start));
    std::move(more.begin(), more.end(), std::back_inserter(followers));
  }
  return followers;
}

LabelledLeader Ask(const dataset::Sequence& sequence, engine::LabelTrack labels,
                   const AskedSamples& asked, uint64_t seed) {
  return {&sequence,
          std::move(labels),
          {seed, asked.variety, asked.candidates, asked.reaction},
          asked.tell_direction,
          asked.live_delay};
}

uint64_t SeedOf(const AskedSamples& asked, const dataset::Dataset& dataset, int sequence, int n) {
  const uint64_t set = asked.seed + static_cast<uint64_t>(n);
  return set * dataset.sequences.size() + static_cast<uint64_t>(sequence);
}

absl::StatusOr<metrics::SampledMotions> AnswerWithSamples(const engine::Synthesizer& synthesizer,
                                                          const dataset::Dataset& dataset,
                                                          const std::vector<int>& sequences,
                                                          StartGiven start,
                                                          const AskedSamples& asked) {
  DUET_RETURN_IF_ERROR(CheckModelTakes(synthesizer.description(), dataset, start));
  const int samples = synthesizer.description().samples ? asked.samples : 1;
  std::vector<LabelledLeader> leaders;
  for (int n = 0; n < samples; ++n) {
    for (const int index : sequences) {
      const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
      const engine::LabelTrack labels(OneClass(dataset.class_count(), sequence.interaction_class));
      leaders.push_back(Ask(sequence, labels, asked, SeedOf(asked, dataset, index, n)));
    }
  }
  DUET_TRY(auto followers, SynthesizeSequences(synthesizer, leaders, start));
  metrics::SampledMotions answers(static_cast<size_t>(samples));
  auto follower = followers.begin();
  for (std::vector<metrics::ScoredMotion>& set : answers) {
    for (const int index : sequences) set.push_back({index, std::move(*follower++)});
  }
  return answers;
}

}  // namespace duet::evaluation::experiments
