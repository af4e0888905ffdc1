#include "model/evaluation/experiments/reaction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/statistics.h"
#include "model/evaluation/experiments/estimate.h"
#include "model/evaluation/experiments/mixes.h"
#include "model/motion/filter.h"
#include "model/motion/resample.h"

namespace duet::evaluation::experiments {
namespace {

using motion::Poses;
using motion::Vec3;

// The time about the leader's action in which a follower goes back.
constexpr double kBeforeActionSeconds = 0.3, kAfterActionSeconds = 1;
// A clip with its first and last frames repeated.
void Pad(int frames, motion::Clip* clip) {
  Poses padded(0, clip->joint_count());
  for (int t = 0; t < frames; ++t) padded.Append(clip->poses[0]);
  padded.Append(clip->poses.all());
  for (int t = 0; t < frames; ++t) padded.Append(clip->poses[clip->frame_count() - 1]);
  clip->poses = std::move(padded);
}

double Rate(const dataset::Sequence& sequence) { return sequence.pair.leader.frame_rate_hz; }

std::vector<double> Positions(const Poses& poses, int joint, Vec3 away) {
  std::vector<double> along;
  for (int t = 0; t < poses.frame_count(); ++t) along.push_back(Dot(poses.at(t, joint), away));
  return along;
}

// The change of the head's and the root's mean position away from the leader in every frame.
std::vector<double> VelocityAway(const Poses& poses, int head, int root, Vec3 away) {
  const std::vector<double> heads = Positions(poses, head, away);
  const std::vector<double> roots = Positions(poses, root, away);
  std::vector<double> velocity(heads.size());
  for (size_t t = 1; t < velocity.size(); ++t) {
    velocity[t] = (heads[t] + roots[t] - heads[t - 1] - roots[t - 1]) / 2;
  }
  return velocity;
}

}  // namespace

int PadSequence(dataset::Sequence* sequence) {
  const int frames = static_cast<int>(std::lround(kPaddingSeconds * Rate(*sequence)));
  Pad(frames, &sequence->pair.leader);
  Pad(frames, &sequence->pair.follower);
  return frames;
}

ReactionMeter::ReactionMeter(const motion::Skeleton& skeleton)
    : skeleton_(skeleton), body_(body::FindBody(skeleton)) {}

bool ReactionMeter::possible() const { return body_.neck && !body_.arms.empty(); }

int ReactionMeter::ActionFrame(const dataset::Sequence& sequence) const {
  const Poses leader = motion::WithoutNoise(sequence.pair.leader.poses, Rate(sequence));
  const Vec3 away = AwayFromLeader(sequence, skeleton_.root);
  int frame = 0;
  float farthest = -INFINITY;
  for (int t = 0; t < leader.frame_count(); ++t) {
    for (const auto* limbs : {&body_.arms, &body_.legs}) {
      for (const body::Limb& limb : *limbs) {
        const float reach = Dot(leader.at(t, limb.end) - leader.at(t, skeleton_.root), away);
        if (reach <= farthest) continue;
        farthest = reach;
        frame = t;
      }
    }
  }
  return frame;
}

Amplitude ReactionMeter::AmplitudeOf(const dataset::Sequence& sequence,
                                     const Poses& follower) const {
  const Vec3 away = AwayFromLeader(sequence, skeleton_.root);
  const double rate = Rate(sequence);
  const int action = ActionFrame(sequence);
  const int first = std::max(0, action - static_cast<int>(kBeforeActionSeconds * rate));
  const int end =
      std::min(follower.frame_count(), action + static_cast<int>(kAfterActionSeconds * rate) + 1);
  const Poses smooth = motion::WithoutNoise(follower, rate);
  const auto back = [&](int joint) {
    const std::vector<double> along = Positions(smooth, joint, away);
    return *std::max_element(along.begin() + first, along.begin() + end) -
           along[static_cast<size_t>(first)];
  };
  return {back(body_.neck->head), back(skeleton_.root)};
}

Amplitude ReactionMeter::Captured(const dataset::Sequence& sequence) const {
  return AmplitudeOf(sequence, sequence.pair.follower.poses);
}

Reaction ReactionMeter::Measure(const dataset::Sequence& sequence, const Poses& follower,
                                int padding) const {
  const double rate = Rate(sequence);
  const int frames = sequence.pair.leader.frame_count();
  const Poses smooth = motion::WithoutNoise(follower, rate);
  const Poses within = motion::Part(smooth, padding, frames);
  const Vec3 away = AwayFromLeader(sequence, skeleton_.root);
  const auto velocity = [&](const Poses& poses) {
    return VelocityAway(poses, body_.neck->head, skeleton_.root, away);
  };
  Reaction reaction;
  reaction.amplitude = AmplitudeOf(sequence, motion::Part(follower, padding, frames));
  reaction.correlation = Correlation(
      velocity(motion::WithoutNoise(sequence.pair.follower.poses, rate)), velocity(within));
  return reaction;
}

namespace {

enum class Part { kHead, kTorso };

double Of(const Amplitude& amplitude, Part part) {
  return part == Part::kHead ? amplitude.head : amplitude.torso;
}

// Rows of pairs, by class.
std::map<int, std::vector<size_t>> ByClass(const std::vector<ReactionPair>& pairs,
                                           const std::vector<size_t>& rows) {
  std::map<int, std::vector<size_t>> by_class;
  for (const size_t row : rows) by_class[pairs[row].interaction_class].push_back(row);
  return by_class;
}

// The figures of all pairs as statistics, padded or not.
class Figures {
 public:
  Figures(const std::vector<ReactionPair>& pairs, Reaction ReactionPair::*which)
      : pairs_(pairs), which_(which) {
    std::vector<size_t> all;
    for (size_t i = 0; i < pairs.size(); ++i) all.push_back(i);
    for (const auto& [c, rows] : ByClass(pairs, all)) {
      for (const Part part : {Part::kHead, Part::kTorso}) {
        captured_means_[{c, part}] =
            Mean(rows, [part](const ReactionPair& pair) { return Of(pair.captured, part); });
      }
    }
  }

  std::vector<std::pair<std::string, Statistic>> All() const {
    return {{"amplitude, head", MeanRatio(Part::kHead)},
            {"amplitude, torso", MeanRatio(Part::kTorso)},
            {"head goes back", GoesBack(Part::kHead)},
            {"torso goes back", GoesBack(Part::kTorso)},
            {"correlation", MeanOf(&Reaction::correlation)}};
  }

 private:
  double Mean(const std::vector<size_t>& rows,
              const std::function<double(const ReactionPair&)>& value) const {
    std::vector<double> values;
    for (const size_t row : rows) values.push_back(value(pairs_[row]));
    return base::Mean(values);
  }
  double Made(const ReactionPair& pair, Part part) const {
    return Of((pair.*which_).amplitude, part);
  }

  Statistic MeanRatio(Part part) const {
    return [this, part](const std::vector<size_t>& rows) {
      return Ratio(Mean(rows, [&](auto& pair) { return Made(pair, part); }),
                   Mean(rows, [&](auto& pair) { return Of(pair.captured, part); }));
    };
  }
  // The share of answers that go back by more than half of the captured mean of their class.
  Statistic GoesBack(Part part) const {
    return [this, part](const std::vector<size_t>& rows) {
      return Mean(rows, [&](auto& pair) {
        const double mean = captured_means_.at({pair.interaction_class, part});
        return Made(pair, part) > mean / 2 ? 1.0 : 0.0;
      });
    };
  }
  Statistic MeanOf(double Reaction::*field) const {
    return [this, field](const std::vector<size_t>& rows) {
      return Mean(rows, [&](auto& pair) { return (pair.*which_).*field; });
    };
  }

  const std::vector<ReactionPair>& pairs_;
  Reaction ReactionPair::*which_;
  std::map<std::pair<int, Part>, double> captured_means_;
};

}  // namespace

std::vector<report::Table> ReactionTables(const std::string& title,
                                          const std::vector<std::string>& classes,
                                          const std::vector<ReactionPair>& pairs) {
  const Figures plain(pairs, &ReactionPair::plain), padded(pairs, &ReactionPair::padded);
  std::vector<int> leaders;
  std::vector<size_t> rows;
  for (const ReactionPair& pair : pairs) {
    leaders.push_back(pair.leader);
    rows.push_back(rows.size());
  }
  report::Table all = EstimateTable(title, {"as captured", "padded"});
  const auto of_plain = plain.All(), of_padded = padded.All();
  for (size_t i = 0; i < of_plain.size(); ++i) {
    AddEstimates(of_plain[i].first,
                 {Bootstrap(leaders, of_plain[i].second), Bootstrap(leaders, of_padded[i].second)},
                 &all);
  }
  all.notes = {
      "Amplitude: how far head and torso go away from the leader, from 0.3 s before to 1 s after "
      "the leader reaches farthest, as a ratio of means to the captured followers. Goes "
      "back: share of answers that go "
      "back by more than half of the captured mean of their class. Correlation: of the velocity "
      "away from the leader with the captured follower's, mean over the answers.",
      absl::StrCat("Padded: the leader holds the first pose for ", kPaddingSeconds,
                   " s before the clip and the last pose as long after it.")};
  report::Table by_class{absl::StrCat(title, ", by class"), {"answers"}};
  by_class.decimals = 3;
  std::vector<Statistic> statistics;
  for (size_t i = 0; i < of_plain.size(); ++i) {
    by_class.columns.push_back(of_plain[i].first);
    by_class.columns.push_back("padded");
    statistics.insert(statistics.end(), {of_plain[i].second, of_padded[i].second});
  }
  for (const auto& [c, of_class] : ByClass(pairs, rows)) {
    report::TableRow row{classes[static_cast<size_t>(c)], {static_cast<double>(of_class.size())}};
    for (const Statistic& statistic : statistics) row.values.push_back(statistic(of_class));
    by_class.rows.push_back(std::move(row));
  }
  return {std::move(all), std::move(by_class)};
}

}  // namespace duet::evaluation::experiments
