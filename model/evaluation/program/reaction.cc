#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <utility>

#include "model/base/random.h"
#include "model/base/statistics.h"
#include "model/evaluation/program/measures.h"
#include "model/motion/filter.h"

namespace duet::evaluation::program {
namespace {

using motion::Poses;
using motion::Vec3;

constexpr double kPaddingSeconds = 1;
// The time about the leader's action in which a follower goes back.
constexpr double kBeforeActionSeconds = 0.3, kAfterActionSeconds = 1;
// A series with a smaller deviation has no correlation with another.
constexpr double kConstant = 1e-9;

// Pearson's correlation; 0 if either side is constant. Shapes: both [samples].
double Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean_a = base::Mean(a), mean_b = base::Mean(b);
  double product = 0, square_a = 0, square_b = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    product += (a[i] - mean_a) * (b[i] - mean_b);
    square_a += std::pow(a[i] - mean_a, 2);
    square_b += std::pow(b[i] - mean_b, 2);
  }
  const double scale = std::sqrt(square_a * square_b);
  return scale > kConstant ? product / scale : 0;
}

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

// The frame in which a hand or foot of the leader reaches farthest towards the follower.
int ActionFrame(const motion::Skeleton& skeleton, const body::Body& body, const Poses& leader,
                Vec3 away) {
  int frame = 0;
  float farthest = -INFINITY;
  for (int t = 0; t < leader.frame_count(); ++t) {
    for (const auto* limbs : {&body.arms, &body.legs}) {
      for (const body::Limb& limb : *limbs) {
        const float reach = Dot(leader.at(t, limb.end) - leader.at(t, skeleton.root), away);
        if (reach <= farthest) continue;
        farthest = reach;
        frame = t;
      }
    }
  }
  return frame;
}

// Repeats the first and last frames.
void Pad(int frames, motion::Clip* clip) {
  Poses padded(0, clip->joint_count());
  for (int t = 0; t < frames; ++t) padded.Append(clip->poses[0]);
  padded.Append(clip->poses.all());
  for (int t = 0; t < frames; ++t) padded.Append(clip->poses[clip->frame_count() - 1]);
  clip->poses = std::move(padded);
}

}  // namespace

int PadSequence(dataset::Sequence* sequence) {
  const double rate = sequence->pair.leader.frame_rate_hz;
  const int frames = static_cast<int>(std::lround(kPaddingSeconds * rate));
  Pad(frames, &sequence->pair.leader);
  Pad(frames, &sequence->pair.follower);
  return frames;
}

Reaction MeasureReaction(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
                         const Poses& follower) {
  const body::Body body = body::FindBody(skeleton);
  const Vec3 away = AwayFromLeader(sequence, skeleton.root);
  const double rate = sequence.pair.leader.frame_rate_hz;
  const auto smooth = [rate](const Poses& poses) { return motion::WithoutNoise(poses, rate); };
  const int action = ActionFrame(skeleton, body, smooth(sequence.pair.leader.poses), away);
  const int first = std::max(0, action - static_cast<int>(kBeforeActionSeconds * rate));
  const int end =
      std::min(follower.frame_count(), action + static_cast<int>(kAfterActionSeconds * rate) + 1);
  const Poses made = smooth(follower);
  const auto back = [&](int joint) {
    const std::vector<double> along = Positions(made, joint, away);
    return *std::max_element(along.begin() + first, along.begin() + end) -
           along[static_cast<size_t>(first)];
  };
  const int head = body.neck->head;
  return {back(head), back(skeleton.root),
          Correlation(VelocityAway(smooth(sequence.pair.follower.poses), head, skeleton.root, away),
                      VelocityAway(made, head, skeleton.root, away))};
}

report::Table ReactionTable(const std::string& title, const std::vector<ReactionPair>& pairs) {
  using Value = std::function<double(const ReactionPair&)>;
  const auto mean = [&pairs](const std::vector<size_t>& rows, const Value& value) {
    std::vector<double> values;
    for (const size_t row : rows) values.push_back(value(pairs[row]));
    return base::Mean(values);
  };
  std::vector<int> leaders;
  std::map<int, std::vector<size_t>> by_class;
  for (size_t row = 0; row < pairs.size(); ++row) {
    leaders.push_back(pairs[row].leader);
    by_class[pairs[row].interaction_class].push_back(row);
  }
  report::Table table = EstimateTable(title, {"as captured", "padded"});
  // Adds a row with the statistic of each kind of answer.
  using Answer = Reaction ReactionPair::*;
  const auto add = [&](const std::string& name, const auto& statistic) {
    report::TableRow& row = table.rows.emplace_back(report::TableRow{name, {}});
    for (const Answer answer : {&ReactionPair::made, &ReactionPair::padded}) {
      AddEstimate(
          leaders, [&](const std::vector<size_t>& rows) { return statistic(rows, answer); }, &row);
    }
  };
  for (const bool head : {true, false}) {
    const auto part = head ? &Reaction::head : &Reaction::torso;
    const Value captured = [part](const ReactionPair& pair) { return pair.captured.*part; };
    const std::string name = head ? "head" : "torso";
    add("amplitude, " + name, [&](const std::vector<size_t>& rows, Answer answer) {
      const Value made = [=](const ReactionPair& pair) { return pair.*answer.*part; };
      return Ratio(mean(rows, made), mean(rows, captured));
    });
    std::map<int, double> usual;
    for (const auto& [c, rows] : by_class) usual[c] = mean(rows, captured);
    add(name + " goes back", [&](const std::vector<size_t>& rows, Answer answer) {
      return mean(rows, [&](const ReactionPair& pair) {
        return pair.*answer.*part > usual.at(pair.interaction_class) / 2 ? 1.0 : 0.0;
      });
    });
  }
  add("correlation", [&](const std::vector<size_t>& rows, Answer answer) {
    return mean(rows, [answer](const ReactionPair& pair) { return (pair.*answer).correlation; });
  });
  table.notes = {
      "Amplitude: how far head and torso go away from the leader, from 0.3 s before to 1 s after "
      "the leader reaches farthest, as a ratio of means to the captured followers. Goes back: "
      "share of answers that go back by more than half of the captured mean of their class. "
      "Correlation: of the velocity away from the leader with the captured follower's, mean over "
      "the answers. Padded: the leader stands still for a second before and after. Low, high: 95 % "
      "interval by the bootstrap over leaders."};
  return table;
}

void AddEstimate(const std::vector<int>& leaders, const Statistic& statistic,
                 report::TableRow* row) {
  constexpr int kResamples = 400;
  std::vector<size_t> all(leaders.size());
  std::iota(all.begin(), all.end(), size_t{0});
  std::map<int, std::vector<size_t>> rows_of;
  for (const size_t i : all) rows_of[leaders[i]].push_back(i);
  std::vector<const std::vector<size_t>*> groups;
  for (const auto& [leader, rows] : rows_of) groups.push_back(&rows);
  base::Random random(0);
  std::vector<double> values;
  for (int n = 0; n < kResamples && !groups.empty(); ++n) {
    std::vector<size_t> drawn;
    for (size_t i = 0; i < groups.size(); ++i) {
      const auto& rows =
          *groups[static_cast<size_t>(random.Below(static_cast<int64_t>(groups.size())))];
      drawn.insert(drawn.end(), rows.begin(), rows.end());
    }
    const double value = statistic(drawn);
    if (!std::isnan(value)) values.push_back(value);
  }
  row->values.insert(row->values.end(), {statistic(all), base::Quantile(values, 0.025),
                                         base::Quantile(values, 0.975)});
}

report::Table EstimateTable(const std::string& title, const std::vector<std::string>& variants) {
  report::Table table{title};
  for (const std::string& variant : variants) {
    table.columns.insert(table.columns.end(), {variant, "low", "high"});
  }
  table.decimals = 3;
  return table;
}

double Ratio(double numerator, double denominator) {
  return denominator == 0 ? NAN : numerator / denominator;
}

}  // namespace duet::evaluation::program
