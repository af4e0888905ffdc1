#include "model/evaluation/experiments/live_reaction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/evaluation/experiments/synthesizer_method.h"
#include "model/evaluation/metrics/liveliness.h"
#include "model/motion/filter.h"
#include "model/motion/resample.h"

namespace duet::evaluation::experiments {
namespace {

using motion::Poses;

constexpr double kRateHz = 30;
constexpr int kStandingFrames = 60;
constexpr int kLabelFrame = 60;
constexpr float kPartedMetres = 0.05f;

// The first frame from `begin` on in which a joint of one motion is far from that of the other.
std::optional<int> PartedAt(const Poses& a, const Poses& b, int begin) {
  for (int t = begin; t < std::min(a.frame_count(), b.frame_count()); ++t) {
    for (int j = 0; j < a.joint_count(); ++j) {
      if (Distance(a.at(t, j), b.at(t, j)) > kPartedMetres) return t;
    }
  }
  return std::nullopt;
}

Poses Standing(const Poses& motion, int frames) {
  Poses standing(0, motion.joint_count());
  for (int t = 0; t < frames; ++t) standing.Append(motion[0]);
  return standing;
}

// A sequence with another leader, at kRateHz.
dataset::Sequence WithLeader(const dataset::Sequence& sequence, Poses leader) {
  dataset::Sequence changed;
  changed.id = sequence.id;
  changed.interaction_class = sequence.interaction_class;
  changed.partner_direction = sequence.partner_direction;
  changed.pair.leader = {sequence.pair.leader.joint_names, kRateHz, std::move(leader)};
  return changed;
}

// The leaders of a sequence: one that stands, then acts; and one that goes on standing.
struct Leaders {
  dataset::Sequence acting, standing;
};

Leaders MakeLeaders(const dataset::Sequence& sequence) {
  const motion::Clip& clip = sequence.pair.leader;
  const Poses moving = motion::Resample(motion::WithoutNoise(clip.poses, clip.frame_rate_hz),
                                        clip.frame_rate_hz, kRateHz);
  Poses acting = Standing(moving, kStandingFrames);
  acting.Append(moving.all());
  Poses standing = Standing(moving, acting.frame_count());
  return {WithLeader(sequence, std::move(acting)), WithLeader(sequence, std::move(standing))};
}

// The class of the sequence until kLabelFrame, then the next one.
engine::LabelTrack ChangingLabels(int classes, int own) {
  return engine::LabelTrack(
      std::vector<engine::LabelKeyframe>{{0, OneClass(classes, own)},
                                         {kLabelFrame - 1, OneClass(classes, own)},
                                         {kLabelFrame, OneClass(classes, (own + 1) % classes)}});
}

double MeanJerk(const Poses& poses) {
  double sum = 0;
  int count = 0;
  for (int t = 3; t < poses.frame_count(); ++t) {
    for (int j = 0; j < poses.joint_count(); ++j, ++count) {
      sum += double{Norm(poses.at(t, j) - poses.at(t - 3, j) +
                         (poses.at(t - 2, j) - poses.at(t - 1, j)) * 3)};
    }
  }
  return sum / std::max(1, count) * kRateHz * kRateHz * kRateHz;
}

}  // namespace

absl::StatusOr<LiveFigures> MeasureLiveReaction(const engine::Synthesizer& synthesizer,
                                                const dataset::Dataset& dataset,
                                                const std::vector<int>& sequences, uint64_t seed,
                                                std::optional<int> live_delay) {
  absl::Status fits = CheckModelFits(synthesizer.description(), dataset);
  if (!fits.ok()) return fits;
  const int classes = dataset.class_count();
  std::vector<Leaders> leaders;
  leaders.reserve(sequences.size());
  for (const int index : sequences) {
    leaders.push_back(MakeLeaders(dataset.sequences[static_cast<std::size_t>(index)]));
  }
  // Of each leader: acting, standing, standing with another label.
  std::vector<LabelledLeader> asked;
  for (std::size_t i = 0; i < leaders.size(); ++i) {
    const int own = leaders[i].acting.interaction_class;
    const engine::Sampling sampling{seed * leaders.size() + i};
    const engine::LabelTrack labels(OneClass(classes, own));
    asked.push_back({&leaders[i].acting, labels, sampling, true, live_delay});
    asked.push_back({&leaders[i].standing, labels, sampling, true, live_delay});
    asked.push_back(
        {&leaders[i].standing, ChangingLabels(classes, own), sampling, true, live_delay});
  }
  absl::StatusOr<std::vector<Poses>> followers =
      SynthesizeSequences(synthesizer, asked, StartGiven::kNone);
  if (!followers.ok()) return followers.status();
  LiveFigures figures;
  figures.clips = static_cast<int>(leaders.size());
  for (std::size_t i = 0; i < leaders.size(); ++i) {
    const Poses &acting = (*followers)[3 * i], &standing = (*followers)[3 * i + 1];
    const std::optional<int> led =
        PartedAt(leaders[i].acting.pair.leader.poses, leaders[i].standing.pair.leader.poses, 0);
    const std::optional<int> followed = PartedAt(acting, standing, 0);
    if (led && followed) figures.reaction_seconds.push_back((*followed - *led) / kRateHz);
    if (const auto changed = PartedAt((*followers)[3 * i + 2], standing, 0)) {
      figures.label_seconds.push_back((*changed - kLabelFrame) / kRateHz);
    }
    figures.speed += metrics::JointSpeed(acting, kRateHz) / figures.clips;
    figures.jerk += MeanJerk(acting) / figures.clips;
  }
  return figures;
}

std::vector<double> CapturedReactions(const dataset::Dataset& dataset,
                                      const std::vector<int>& sequences) {
  std::vector<double> seconds;
  for (const int index : sequences) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<std::size_t>(index)];
    const auto departure = [](const motion::Clip& clip) {
      const Poses moving = motion::Resample(motion::WithoutNoise(clip.poses, clip.frame_rate_hz),
                                            clip.frame_rate_hz, kRateHz);
      return PartedAt(moving, Standing(moving, moving.frame_count()), 0);
    };
    const auto led = departure(sequence.pair.leader), followed = departure(sequence.pair.follower);
    if (led && followed) seconds.push_back((*followed - *led) / kRateHz);
  }
  return seconds;
}

}  // namespace duet::evaluation::experiments
