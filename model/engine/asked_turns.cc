#include "model/engine/asked_turns.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/angle.h"
#include "model/base/median.h"
#include "model/engine/candidates.h"
#include "model/engine/finishing.h"

namespace duet::engine {
namespace {

constexpr double kLeastDemand = 0.1;  // a label that only touches the end of a window
// The share of the speed of captured turns that counts as doing what is asked.
constexpr double kEnoughSpeed = 0.6;
constexpr double kFreeDegrees = 120;  // of turning that no label avoids
constexpr double kLeastTurn = 230;    // degrees
constexpr std::size_t kFewestStretches = 3;
// Degrees that followers may turn in other classes. 98 % of captured followers turn less within the
// frames of a window.
constexpr double kMostInOthers = 180;
constexpr double kMostDraws = 6;
constexpr int kDrawnTogether = 2;
// Fraction of these samples that a window draws on average, measured on held-out takes
// (docs/results/README.md, "The dance").
constexpr double kDrawnForTurns = 0.8, kDrawnForOthers = 0.05;
// Samples agree on the direction of a turn if the difference between both directions is at least
// this fraction of all their turning.
constexpr double kAgreement = 0.6;
constexpr std::size_t kFewestVotes = 3;
// Weight of turning in the direction that the samples did not agree on.
constexpr double kAgainstTheOthers = 0.7;
constexpr float kMostGain = 4;
constexpr int kGains = 4;  // different gains, evenly up to the largest
// What a mean difference of a whole turn from the other samples costs.
constexpr double kUntypical = 0.5;

// The direction of a person's hips against the line to the partner, degrees; jumps by whole turns.
double Direction(const motion::JointPair& hips, int root, const motion::Poses& person,
                 const motion::Poses& partner, int frame) {
  const motion::Vec3 across = person.at(frame, hips.left) - person.at(frame, hips.right);
  const motion::Vec3 line = partner.at(frame, root) - person.at(frame, root);
  return (std::atan2(across.z, across.x) - std::atan2(line.z, line.x)) / base::kRadiansPerDegree;
}

// The places of the turning classes in the label vector.
std::vector<std::size_t> TurningIndices(const ModelDescription& description) {
  const auto& classes = description.classes;
  std::vector<std::size_t> indices;
  for (const TurningClass& turning : description.turning_classes) {
    indices.push_back(static_cast<std::size_t>(
        std::find(classes.begin(), classes.end(), turning.interaction_class) - classes.begin()));
  }
  return indices;
}

// How far the person turns from one frame to the next, degrees.
double TurnedAt(const motion::JointPair& hips, int root, const motion::Poses& person,
                const motion::Poses& partner, int frame) {
  const double turned = Direction(hips, root, person, partner, frame) -
                        Direction(hips, root, person, partner, frame - 1);
  return turned - 360 * std::round(turned / 360);
}

// The largest turn each way, with or without pauses and small turns back.
class TurnedRange {
 public:
  void Add(double degrees) {
    at_ += degrees;
    lowest_ = std::min(lowest_, at_);
    highest_ = std::max(highest_, at_);
    forwards_ = std::max(forwards_, at_ - lowest_);
    backwards_ = std::max(backwards_, highest_ - at_);
  }
  double forwards() const { return forwards_; }
  double backwards() const { return backwards_; }
  double farthest() const { return std::max(forwards_, backwards_); }

 private:
  double at_ = 0, lowest_ = 0, highest_ = 0, forwards_ = 0, backwards_ = 0;
};

// How far a follower turns where turns are asked for, where a negative weight avoids them, and
// where another class does.
struct Turned {
  TurnedRange asked, avoided, other;
};

Turned Split(const std::vector<double>& turns, const std::vector<double>& wanted,
             const std::vector<bool>& other) {
  Turned turned;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const double degrees = turns[i] - (i == 0 ? 0 : turns[i - 1]);
    if (wanted[i] > 0) turned.asked.Add(degrees);
    if (wanted[i] < 0) turned.avoided.Add(degrees);
    if (other[i]) turned.other.Add(degrees);
  }
  return turned;
}

// What the labels of one frame request.
struct FrameLabels {
  double degrees = 0;             // of turning; negative to avoid turns
  double asked = 0, avoided = 0;  // sum of the absolute weights of turns
  double other = 0;               // largest weight of another class, if no turn has a weight
};

// `turning`: TurningIndices.
FrameLabels ReadLabels(const ModelDescription& description, const std::vector<std::size_t>& turning,
                       const float* weights) {
  FrameLabels labels;
  for (std::size_t k = 0; k < turning.size(); ++k) {
    const double weight = std::clamp(double{weights[turning[k]]}, -1.0, 1.0);
    labels.degrees +=
        weight * description.turning_classes[k].degrees_per_second / description.frame_rate_hz;
    (weight > 0 ? labels.asked : labels.avoided) += std::abs(weight);
  }
  const double most = *std::max_element(weights, weights + description.classes.size());
  if (labels.asked + labels.avoided == 0) labels.other = std::clamp(most, 0.0, 1.0);
  return labels;
}

// Where turns are asked for: the sum of the samples' turns, whose sign is the direction in which
// they turn farther, and the sum of the absolute values.
struct Votes {
  double way = 0, all = 0;
};

Votes VotesOf(const AskedTurns& turns, const std::vector<std::vector<double>>& samples) {
  Votes votes;
  for (const std::vector<double>& sample : samples) {
    const double asked = turns.Asked(sample);
    votes.way += asked;
    votes.all += std::abs(asked);
  }
  return votes;
}

// How far the turns of two samples differ, in whole turns. Shapes: both alike.
double Apart(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / 360 / std::max(1.0, static_cast<double>(a.size()));
}

}  // namespace

AskedTurns::AskedTurns(const ModelDescription& description, const SynthesisWindow& window) {
  if (description.turning_classes.empty() || !description.skeleton.hips) return;
  root_ = description.skeleton.root;
  hips_ = *description.skeleton.hips;
  const int judged = std::max(1, SettledFrames(window));
  const int end = window.leader.frame_count() - description.lookahead_frames;
  if (end <= judged) return;
  const std::vector<std::size_t> turning = TurningIndices(description);
  const std::size_t classes = description.classes.size();
  for (int t = 1; t < end; ++t) {
    const FrameLabels labels = ReadLabels(
        description, turning, window.labels.data() + static_cast<std::size_t>(t) * classes);
    const bool is_judged = t >= judged;
    wanted_.push_back(is_judged ? labels.degrees : 0);
    other_.push_back(labels.other > 0);
    if (!is_judged) continue;
    asked_ += std::max(0.0, labels.degrees);
    share_asked_ += labels.asked;
    share_avoided_ += labels.avoided;
    share_other_ += labels.other;
  }
  for (double* share : {&share_asked_, &share_avoided_, &share_other_}) {
    *share /= end - judged;
  }
  demand_ = share_asked_ + share_avoided_ > 0 ? share_asked_ + share_avoided_ : share_other_;
  if (demand_ < kLeastDemand) demand_ = 0;
}

std::vector<double> AskedTurns::TurnsOf(const motion::Poses& leader,
                                        const motion::Poses& follower) const {
  std::vector<double> turns;
  double sum = 0;
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    sum += TurnedAt(hips_, root_, follower, leader, static_cast<int>(i) + 1);
    turns.push_back(sum);
  }
  return turns;
}

double AskedTurns::Asked(const std::vector<double>& turns) const {
  const TurnedRange asked = Split(turns, wanted_, other_).asked;
  return asked.forwards() > asked.backwards() ? asked.forwards() : -asked.backwards();
}

double AskedTurns::Miss(const std::vector<double>& turns, double way) const {
  if (demand_ == 0) return 0;
  const Turned turned = Split(turns, wanted_, other_);
  const double forwards = turned.asked.forwards(), backwards = turned.asked.backwards();
  double miss = 0;
  if (asked_ > 0) {
    const double most = std::max(forwards, backwards);
    const double right = way == 0 ? most : way > 0 ? forwards : backwards;
    const double counts = right + kAgainstTheOthers * (most - right);
    miss += share_asked_ * std::max(0.0, 1 - counts / (kEnoughSpeed * asked_));
  }
  miss += share_avoided_ * std::max(0.0, turned.avoided.farthest() - kFreeDegrees) / kLeastTurn;
  return miss + std::max(0.0, turned.other.farthest() / kMostInOthers - 1);
}

int AskedTurns::further_samples() const {
  return static_cast<int>(std::ceil(kMostDraws * std::min(1.0, demand_)));
}

double AskedTurns::share_drawn() const {
  return share_asked_ + share_avoided_ > 0 ? kDrawnForTurns : kDrawnForOthers;
}

std::vector<std::vector<NetworkInput>> DrawnAgain(const ModelDescription& description,
                                                  const AskedTurns& turns,
                                                  const SynthesisWindow& window,
                                                  const NetworkInput& input) {
  std::vector<std::vector<NetworkInput>> groups;
  for (int n = 1; n <= turns.further_samples(); ++n) {
    if ((n - 1) % kDrawnTogether == 0) groups.emplace_back();
    NetworkInput& again = groups.back().emplace_back(input);
    const Sampling& sampling = window.options.sampling;
    again.sampling.seed = CandidateSeed(sampling.seed, sampling.candidates + n - 1);
    const float gain = 1 + (kMostGain - 1) * static_cast<float>(n % kGains + 1) / kGains;
    for (const std::size_t c : TurningIndices(description)) {
      for (std::size_t i = c; i < again.labels.size(); i += description.classes.size()) {
        again.labels[i] *= gain;
      }
    }
  }
  return groups;
}

bool IsDecided(const AskedTurns& turns, const std::vector<std::vector<double>>& samples) {
  const Votes votes = VotesOf(turns, samples);
  if (turns.asks() &&
      (samples.size() < kFewestVotes || std::abs(votes.way) < kAgreement * votes.all)) {
    return false;
  }
  return std::any_of(samples.begin(), samples.end(), [&](const std::vector<double>& sample) {
    return turns.Miss(sample, votes.way) <= turns.tolerated();
  });
}

std::size_t MostAsAsked(const AskedTurns& turns, const std::vector<std::vector<double>>& samples) {
  const double way = VotesOf(turns, samples).way;
  std::vector<double> costs;
  for (const std::vector<double>& sample : samples) {
    const double miss = turns.Miss(sample, way);
    costs.push_back(miss <= turns.tolerated() ? 0 : miss);
  }
  const double least = *std::min_element(costs.begin(), costs.end());
  std::vector<std::size_t> best;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (costs[i] <= least) best.push_back(i);
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double apart = 0, others = 0;
    for (const std::size_t other : best) {
      if (other == i) continue;
      apart += Apart(samples[i], samples[other]);
      ++others;
    }
    if (others > 0) costs[i] += kUntypical * apart / others;
  }
  return static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
}

double ExpectedSamples(const ModelDescription& description, const SynthesisWindow& window) {
  const Sampling& sampling = window.options.sampling;
  const int candidates = CandidateCount(description, sampling);
  if (!description.samples || sampling.first_frame) return candidates;
  const AskedTurns turns(description, window);
  return candidates + turns.share_drawn() * turns.further_samples();
}

void TurningFit::Add(const motion::Poses& leader, const motion::Poses& follower, int begin,
                     int end) {
  if (!skeleton_.hips) return;
  double turned = 0;
  for (int t = begin + 1; t < end; ++t) {
    turned += TurnedAt(*skeleton_.hips, skeleton_.root, follower, leader, t);
  }
  if (end - begin < 2) return;
  degrees_.push_back(std::abs(turned));
  per_frame_.push_back(std::abs(turned) / (end - begin));
}

std::optional<double> TurningFit::DegreesPerSecond(double frame_rate_hz) const {
  if (degrees_.size() < kFewestStretches) return std::nullopt;
  if (base::Median(degrees_) < kLeastTurn) return std::nullopt;
  return base::Median(per_frame_) * frame_rate_hz;
}

}  // namespace duet::engine
