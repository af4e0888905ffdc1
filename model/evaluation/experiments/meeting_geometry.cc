#include "model/evaluation/experiments/meeting_geometry.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "absl/types/span.h"
#include "model/base/angle.h"
#include "model/base/statistics.h"
#include "model/motion/filter.h"

namespace duet::evaluation::experiments {
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

std::vector<double> MeetingGeometry::Measure(const Poses& leader, const Poses& follower, Vec3 away,
                                             double rate) const {
  const Poses partner = motion::WithoutNoise(leader, rate);
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
    const motion::ClipPair& pair = sequence.pair;
    const std::vector<double> measured = geometry.Measure(
        pair.leader.poses, pair.follower.poses, AwayFromLeader(sequence, dataset.skeleton.root),
        pair.leader.frame_rate_hz);
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

}  // namespace duet::evaluation::experiments
