#include "model/evaluation/experiments/live_reaction.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "model/base/status_macros.h"
#include "model/body/liveliness.h"
#include "model/body/motion_quality.h"
#include "model/evaluation/experiments/answers.h"
#include "model/motion/filter.h"
#include "model/motion/resample.h"

namespace duet::evaluation::experiments {
namespace {

using motion::Poses;

constexpr double kRateHz = 30;
constexpr int kStandingFrames = 60;
constexpr int kLabelFrame = 60;
constexpr float kPartedMetres = 0.05f;

// The first frame in which a joint of one motion is far from that of the other.
std::optional<int> PartedAt(const Poses& a, const Poses& b) {
  for (int t = 0; t < std::min(a.frame_count(), b.frame_count()); ++t) {
    for (int j = 0; j < a.joint_count(); ++j) {
      if (Distance(a.at(t, j), b.at(t, j)) > kPartedMetres) return t;
    }
  }
  return std::nullopt;
}

// At kRateHz, without noise.
Poses Calm(const motion::Clip& clip) {
  return motion::Resample(motion::WithoutNoise(clip.poses, clip.frame_rate_hz), clip.frame_rate_hz,
                          kRateHz);
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
  const Poses moving = Calm(sequence.pair.leader);
  Poses acting = Standing(moving, kStandingFrames);
  acting.Append(moving.all());
  Poses standing = Standing(moving, acting.frame_count());
  return {WithLeader(sequence, std::move(acting)), WithLeader(sequence, std::move(standing))};
}

}  // namespace

absl::StatusOr<LiveFigures> MeasureLiveReaction(const engine::Synthesizer& synthesizer,
                                                const dataset::Dataset& dataset,
                                                const std::vector<int>& sequences, uint64_t seed,
                                                std::optional<int> live_delay) {
  DUET_RETURN_IF_ERROR(CheckModelFits(synthesizer.description(), dataset));
  const int classes = dataset.class_count();
  std::vector<Leaders> leaders;
  for (const int index : sequences) {
    leaders.push_back(MakeLeaders(dataset.sequences[static_cast<std::size_t>(index)]));
  }
  // Of each leader: acting, standing, standing with another label.
  std::vector<LabelledLeader> asked;
  for (std::size_t i = 0; i < leaders.size(); ++i) {
    const int own = leaders[i].acting.interaction_class;
    const engine::Sampling sampling{seed * leaders.size() + i};
    const engine::LabelTrack labels(OneClass(classes, own));
    engine::LabelTrack changing = labels;
    changing.Change(kLabelFrame, /*ease_frames=*/0, OneClass(classes, (own + 1) % classes));
    asked.push_back({&leaders[i].acting, labels, sampling, true, live_delay});
    asked.push_back({&leaders[i].standing, labels, sampling, true, live_delay});
    asked.push_back({&leaders[i].standing, std::move(changing), sampling, true, live_delay});
  }
  DUET_TRY(auto followers, SynthesizeSequences(synthesizer, asked, StartGiven::kNone));
  LiveFigures figures;
  figures.clips = static_cast<int>(leaders.size());
  for (std::size_t i = 0; i < leaders.size(); ++i) {
    const Poses &acting = followers[3 * i], &standing = followers[3 * i + 1];
    const std::optional<int> led =
        PartedAt(leaders[i].acting.pair.leader.poses, leaders[i].standing.pair.leader.poses);
    const std::optional<int> followed = PartedAt(acting, standing);
    if (led && followed) figures.reaction_seconds.push_back((*followed - *led) / kRateHz);
    if (const auto changed = PartedAt(followers[3 * i + 2], standing)) {
      figures.label_seconds.push_back((*changed - kLabelFrame) / kRateHz);
    }
    figures.speed += body::JointSpeed(acting, kRateHz) / figures.clips;
    figures.jerk += body::Jitter(acting, kRateHz) / figures.clips;
  }
  return figures;
}

std::vector<double> CapturedReactions(const dataset::Dataset& dataset,
                                      const std::vector<int>& sequences) {
  std::vector<double> seconds;
  for (const int index : sequences) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<std::size_t>(index)];
    const auto departure = [](const motion::Clip& clip) {
      const Poses moving = Calm(clip);
      return PartedAt(moving, Standing(moving, moving.frame_count()));
    };
    const auto led = departure(sequence.pair.leader), followed = departure(sequence.pair.follower);
    if (led && followed) seconds.push_back((*followed - *led) / kRateHz);
  }
  return seconds;
}

}  // namespace duet::evaluation::experiments
