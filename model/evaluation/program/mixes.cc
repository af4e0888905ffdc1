#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>

#include "absl/types/span.h"
#include "model/base/angle.h"
#include "model/base/statistics.h"
#include "model/evaluation/program/measures.h"
#include "model/motion/filter.h"

namespace duet::evaluation::program {
namespace {

using motion::Poses;
using motion::Vec3;

// Leaning back is measured against this many first frames.
constexpr size_t kUprightFrames = 3;
// A trunk that is shorter than this, seen from the front, has no lean.
constexpr double kLeastTrunkMetres = 0.05;

double Largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}
double Smallest(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

// The largest rise of a series after any earlier value.
double LargestRise(const std::vector<double>& values) {
  double lowest = values.front(), rise = 0;
  for (const double value : values) {
    lowest = std::min(lowest, value);
    rise = std::max(rise, value - lowest);
  }
  return rise;
}

Vec3 JointOf(absl::Span<const Vec3> pose, int joint) { return pose[static_cast<size_t>(joint)]; }

// What changes over a clip, a value a frame. Metres; lean in degrees, backwards positive.
struct Series {
  std::vector<double> apart, hands_around, hand_around, hands_meet;  // distances from the leader
  std::vector<double> more_reach, less_reach;  // of the hands towards the leader, past the root
  std::vector<double> head, root, hips;        // away from the leader
  std::vector<double> lean, raised_hand;
};

}  // namespace

MeetingGeometry::MeetingGeometry(const motion::Skeleton& skeleton)
    : skeleton_(skeleton), body_(body::FindBody(skeleton)) {}

bool MeetingGeometry::possible() const {
  return skeleton_.hips && body_.chest && body_.neck && body_.arms.size() == 2;
}

const std::vector<std::string>& MeetingGeometry::Features() {
  static const auto* const kFeatures = new std::vector<std::string>{
      "near",          "hands around",  "a hand around",   "hands meet",   "one hand out",
      "hand out",      "hands out",     "head recoils",    "root recoils", "hips recoil",
      "head retreats", "root retreats", "root approaches", "leans back",   "leans forward",
      "hand raised"};
  return *kFeatures;
}

std::vector<double> MeetingGeometry::Measure(const dataset::Sequence& sequence,
                                             const Poses& follower) const {
  const Vec3 away = AwayFromLeader(sequence, skeleton_.root);
  const double rate = sequence.pair.leader.frame_rate_hz;
  const Poses partner = motion::WithoutNoise(sequence.pair.leader.poses, rate);
  const Poses poses = motion::WithoutNoise(follower, rate);
  Series series;
  for (int t = 0; t < poses.frame_count(); ++t) {
    const absl::Span<const Vec3> self = poses[t], other = partner[t];
    const Vec3 root = JointOf(self, skeleton_.root), chest = JointOf(self, *body_.chest);
    const Vec3 spine = Lerp(JointOf(other, *body_.chest), JointOf(other, skeleton_.root), 0.5f);
    const Vec3 between = root - JointOf(other, skeleton_.root);
    series.apart.push_back(std::hypot(double{between.x}, double{between.z}));
    std::vector<double> around, reach, raised;
    double meet = std::numeric_limits<double>::infinity();
    for (const body::Limb& arm : body_.arms) {
      const Vec3 hand = JointOf(self, arm.end);
      around.push_back(Distance(hand, spine));
      reach.push_back(Dot(root - hand, away));
      raised.push_back(hand.y - chest.y);
      for (const body::Limb& held : body_.arms) {
        meet = std::min(meet, double{Distance(hand, JointOf(other, held.end))});
      }
    }
    series.hands_around.push_back(base::Mean(around));
    series.hand_around.push_back(Largest(around));
    series.hands_meet.push_back(meet);
    series.more_reach.push_back(Largest(reach));
    series.less_reach.push_back(Smallest(reach));
    series.raised_hand.push_back(Largest(raised));
    const Vec3 hips =
        Lerp(JointOf(self, skeleton_.hips->left), JointOf(self, skeleton_.hips->right), 0.5f);
    series.head.push_back(Dot(JointOf(self, body_.neck->head), away));
    series.root.push_back(Dot(root, away));
    series.hips.push_back(Dot(hips, away));
    series.lean.push_back(base::kDegreesPerRadian *
                          std::atan2(double{Dot(chest - root, away)},
                                     std::max(kLeastTrunkMetres, double{chest.y - root.y})));
  }
  std::vector<double> uneven;
  for (size_t t = 0; t < series.lean.size(); ++t) {
    uneven.push_back(series.more_reach[t] - series.less_reach[t]);
  }
  const std::vector<double> upright(
      series.lean.begin(), series.lean.begin() + static_cast<std::ptrdiff_t>(
                                                     std::min(kUprightFrames, series.lean.size())));
  return {-Smallest(series.apart),
          -Smallest(series.hands_around),
          -Smallest(series.hand_around),
          -Smallest(series.hands_meet),
          Largest(uneven),
          Largest(series.more_reach),
          Largest(series.less_reach),
          LargestRise(series.head),
          LargestRise(series.root),
          LargestRise(series.hips),
          Largest(series.head) - series.head.front(),
          Largest(series.root) - series.root.front(),
          series.root.front() - Smallest(series.root),
          Largest(series.lean) - base::Mean(upright),
          -Smallest(series.lean),
          Largest(series.raised_hand)};
}

Vec3 AwayFromLeader(const dataset::Sequence& sequence, int root) {
  Vec3 away = sequence.pair.follower.at(0, root) - sequence.pair.leader.at(0, root);
  away.y = 0;
  const float length = Norm(away);
  return length > 0 ? away / length : Vec3{1, 0, 0};
}

double ClassGeometry::Own(int of_class, int other, size_t feature) const {
  const auto a = static_cast<size_t>(of_class), b = static_cast<size_t>(other);
  const double difference = means[a][feature] - means[b][feature];
  const double spread =
      std::sqrt((std::pow(deviations[a][feature], 2) + std::pow(deviations[b][feature], 2)) / 2);
  return difference > spread ? difference : 0;
}

ClassGeometry MeasureClasses(const MeetingGeometry& geometry, const dataset::Dataset& dataset,
                             const std::vector<int>& sequences) {
  const size_t features = MeetingGeometry::Features().size();
  // Shapes: [classes][features][sequences of the class].
  std::vector<std::vector<std::vector<double>>> values(dataset.classes.size(),
                                                       std::vector<std::vector<double>>(features));
  for (const int index : sequences) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    const std::vector<double> measured = geometry.Measure(sequence, sequence.pair.follower.poses);
    for (size_t f = 0; f < features; ++f) {
      values[static_cast<size_t>(sequence.interaction_class)][f].push_back(measured[f]);
    }
  }
  ClassGeometry classes;
  for (const auto& of_class : values) {
    auto& means = classes.means.emplace_back();
    auto& deviations = classes.deviations.emplace_back();
    for (const std::vector<double>& of_feature : of_class) {
      const base::MeanAndDeviation summary = base::Summarise(of_feature);
      means.push_back(summary.mean);
      deviations.push_back(summary.deviation);
    }
  }
  return classes;
}

namespace {

// A feature counts for a model whose single answers differ by at least this share of the captures'
// difference; below it, what a mix keeps is a ratio of noise.
constexpr double kLeastDifference = 0.3;
// What a mix keeps of one feature is limited to this range: no single feature decides the mean.
constexpr double kLeastKept = -0.5, kMostKept = 1.5;

int Likeliest(const std::vector<float>& probabilities) {
  return static_cast<int>(std::max_element(probabilities.begin(), probabilities.end()) -
                          probabilities.begin());
}

double DistanceOf(const motion::Poses& a, const motion::Poses& b) {
  double sum = 0;
  for (size_t i = 0; i < a.all().size(); ++i) {
    const motion::Vec3 apart = a.all()[i] - b.all()[i];
    sum += double{Dot(apart, apart)};
  }
  return std::sqrt(sum);
}

// By how much single answers to the class of lower index exceed those to the other one, mean over
// all answers to the pair. Shapes: by pair, [features].
std::map<std::pair<int, int>, std::vector<double>> SingleDifferences(
    const std::vector<MixedAnswer>& answers) {
  std::map<std::pair<int, int>, std::vector<double>> sums;
  std::map<std::pair<int, int>, int> counts;
  for (const MixedAnswer& answer : answers) {
    const std::pair<int, int> pair = std::minmax(answer.own, answer.other);
    const double sign = answer.own < answer.other ? 1 : -1;
    std::vector<double>& sum = sums[pair];
    sum.resize(answer.mixed.size());
    for (size_t f = 0; f < sum.size(); ++f) {
      sum[f] += sign * (answer.own_alone[f] - answer.other_alone[f]);
    }
    ++counts[pair];
  }
  for (auto& [pair, sum] : sums) {
    for (double& value : sum) value /= counts[pair];
  }
  return sums;
}

// What remains of one class's own geometry.
double KeptOf(const MixedAnswer& answer, bool is_own, const ClassGeometry& captured,
              const std::vector<double>& single) {
  const int kept = is_own ? answer.own : answer.other, lost = is_own ? answer.other : answer.own;
  const std::vector<double>& without = is_own ? answer.other_alone : answer.own_alone;
  std::vector<double> shares;
  for (size_t f = 0; f < single.size(); ++f) {
    const double expected = captured.Own(kept, lost, f);
    const double difference = kept < lost ? single[f] : -single[f];
    if (expected == 0 || difference < kLeastDifference * expected) continue;
    shares.push_back(
        std::clamp((answer.mixed[f] - without[f]) / difference, kLeastKept, kMostKept));
  }
  return base::Mean(shares);
}

struct MixFigure {
  const char* name;
  double (*of)(const MixedAnswer& answer, const Kept& kept);
};

constexpr MixFigure kMixFigures[] = {
    {"weaker ingredient", [](auto&, const Kept& kept) { return kept.weaker(); }},
    {"both above half", [](auto&, const Kept& kept) { return kept.both(); }},
    {"own ingredient", [](auto&, const Kept& kept) { return kept.own; }},
    {"other ingredient", [](auto&, const Kept& kept) { return kept.other; }},
    {"third class",
     [](const MixedAnswer& answer, auto&) {
       const int likeliest = Likeliest(answer.probabilities);
       return likeliest != answer.own && likeliest != answer.other ? 1.0 : 0.0;
     }},
    {"deviation from average", [](auto& a, auto&) { return a.deviation; }},
    {"twisted", [](auto& a, auto&) { return a.twisted; }},
    {"overlap", [](auto& a, auto&) { return a.overlapping; }},
    {"skate", [](auto& a, auto&) { return a.skating; }}};

}  // namespace

double Deviation(const motion::Poses& mixed, const motion::Poses& own, const motion::Poses& other) {
  motion::Poses average = own;
  for (size_t i = 0; i < average.all().size(); ++i) {
    average.all()[i] = Lerp(own.all()[i], other.all()[i], 0.5f);
  }
  const double scale = DistanceOf(own, other) / 2;
  return Ratio(DistanceOf(mixed, average), scale);
}

double Kept::weaker() const {
  return std::isnan(own) || std::isnan(other) ? NAN : std::min(own, other);
}

double Kept::both() const { return std::isnan(weaker()) ? NAN : weaker() > 0.5 ? 1 : 0; }

std::vector<Kept> MeasureKept(const std::vector<MixedAnswer>& answers,
                              const std::vector<ClassGeometry>& folds) {
  const auto differences = SingleDifferences(answers);
  std::vector<Kept> all;
  for (const MixedAnswer& answer : answers) {
    const std::vector<double>& single = differences.at(std::minmax(answer.own, answer.other));
    const ClassGeometry& captured = folds[static_cast<size_t>(answer.fold)];
    all.push_back(
        {KeptOf(answer, true, captured, single), KeptOf(answer, false, captured, single)});
  }
  return all;
}

report::Table MixTable(const std::string& title, const std::vector<ClassGeometry>& folds,
                       const std::vector<MixVariant>& variants) {
  std::vector<std::string> names;
  std::vector<std::vector<Kept>> kept;
  for (const auto& [name, answers] : variants) {
    names.push_back(name);
    kept.push_back(MeasureKept(answers, folds));
  }
  report::Table table = EstimateTable(title, names);
  for (const MixFigure& figure : kMixFigures) {
    report::TableRow row{figure.name, {}};
    for (size_t v = 0; v < variants.size(); ++v) {
      const std::vector<MixedAnswer>& answers = variants[v].second;
      std::vector<int> leaders;
      for (const MixedAnswer& answer : answers) leaders.push_back(answer.leader);
      const auto mean = [&](const std::vector<size_t>& rows) {
        std::vector<double> values;
        for (const size_t i : rows) values.push_back(figure.of(answers[i], kept[v][i]));
        return base::Mean(values);
      };
      AddEstimate(leaders, mean, &row);
    }
    table.rows.push_back(std::move(row));
  }
  table.notes = {
      "Ingredients: how much of each class's own geometry the answer keeps, between the same "
      "leader's answer to the other class alone (0) and to this class alone (1). A class's own "
      "geometry: the features that are larger in its training captures than in the other class's, "
      "by more than their spread. Pairs in which a class has none do not count.",
      "Third class: share that the judge assigns to neither class. Deviation from average: 0 for "
      "the average of the two single answers, 1 for one of them. Twisted, overlap, skate: shares "
      "of frames. One label: the own class alone.",
      "Low, high: 95 % interval by the bootstrap over leaders."};
  return table;
}

report::Table AvoidTable(const std::string& title, const std::vector<AvoidingAnswer>& answers) {
  using Value = std::function<double(const AvoidingAnswer&)>;
  const auto probability = [](const std::vector<float>& of, int label) {
    return double{of[static_cast<size_t>(label)]};
  };
  const Value asked = [=](auto& a) { return probability(a.avoiding, a.own); };
  const Value alone = [=](auto& a) { return probability(a.alone, a.own); };
  const Value recognised = [](auto& a) { return Likeliest(a.avoiding) == a.own ? 1.0 : 0.0; };
  const Value recognised_alone = [](auto& a) { return Likeliest(a.alone) == a.own ? 1.0 : 0.0; };
  const struct {
    const char* name;
    Value of, base;  // base: none, or what its mean is divided by
  } kFigures[] = {
      {"requested, of alone", asked, alone},
      {"recognised, of alone", recognised, recognised_alone},
      {"avoided", [=](auto& a) { return probability(a.avoiding, a.avoided); }, nullptr},
      {"avoided, alone", [=](auto& a) { return probability(a.alone, a.avoided); }, nullptr},
      {"distance moved", [](auto& a) { return std::abs(a.moved); }, nullptr}};
  std::vector<int> leaders;
  for (const AvoidingAnswer& answer : answers) leaders.push_back(answer.leader);
  report::Table table = EstimateTable(title, {"own 1, other -1"});
  for (const auto& figure : kFigures) {
    const auto mean = [&](const std::vector<size_t>& rows, const Value& value) {
      std::vector<double> values;
      for (const size_t i : rows) values.push_back(value(answers[i]));
      return base::Mean(values);
    };
    const auto statistic = [&](const std::vector<size_t>& rows) {
      const double value = mean(rows, figure.of);
      return figure.base ? Ratio(value, mean(rows, figure.base)) : value;
    };
    AddEstimate(leaders, statistic, &table.rows.emplace_back(report::TableRow{figure.name, {}}));
  }
  table.notes = {
      "Requested, avoided: the judge's probability of the own class and of the class at -1; "
      "recognised: share of answers whose likeliest class is the own one; of alone: as a ratio to "
      "the own class at 1 by itself. Distance moved: of the roots, from that answer's, metres."};
  return table;
}

}  // namespace duet::evaluation::program
