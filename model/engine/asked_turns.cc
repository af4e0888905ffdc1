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
constexpr double kMostDraws = 7;
// How often the first sample of a window misses: measured with answers to takes that were left out
// of training (docs/results/README.md, "The dance").
constexpr double kTurnsMissed = 0.6, kOthersMissed = 0.03;
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
  first_ = std::max(1, SettledFrames(window));
  const int end = window.leader.frame_count() - description.lookahead_frames;
  if (end <= first_) return;
  wanted_.resize(static_cast<std::size_t>(end - first_));
  other_.resize(wanted_.size());
  const std::vector<std::size_t> turning = TurningIndices(description);
  const std::size_t classes = description.classes.size();
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    const float* weights = window.labels.data() + (static_cast<std::size_t>(first_) + i) * classes;
    double largest = 0;
    for (std::size_t k = 0; k < turning.size(); ++k) {
      const double weight = std::clamp(double{weights[turning[k]]}, -1.0, 1.0);
      wanted_[i] +=
          weight * description.turning_classes[k].degrees_per_second / description.frame_rate_hz;
      (weight > 0 ? share_asked_ : share_avoided_) += std::abs(weight);
      largest = std::max(largest, std::abs(weight));
    }
    asked_ += std::max(0.0, wanted_[i]);
    const double most = std::min(1.0, double{*std::max_element(weights, weights + classes)});
    other_[i] = largest == 0 && most > 0;
    if (other_[i]) share_other_ += most;
  }
  for (double* share : {&share_asked_, &share_avoided_, &share_other_}) {
    *share /= static_cast<double>(wanted_.size());
  }
  demand_ = share_asked_ + share_avoided_ > 0 ? share_asked_ + share_avoided_ : share_other_;
  if (demand_ < kLeastDemand) demand_ = 0;
}

std::vector<double> AskedTurns::TurnsOf(const motion::Poses& leader,
                                        const motion::Poses& follower) const {
  std::vector<double> turns;
  double sum = 0;
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    sum += TurnedAt(hips_, root_, follower, leader, first_ + static_cast<int>(i));
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
    const double counts = way == 0 ? most : way > 0 ? forwards : backwards;
    miss += share_asked_ * std::max(0.0, 1 - counts / (kEnoughSpeed * asked_));
  }
  miss += share_avoided_ * std::max(0.0, turned.avoided.farthest() - kFreeDegrees) / kLeastTurn;
  // Whole turns only: in other classes, people turn a little.
  return miss + std::max(0.0, turned.other.farthest() / kLeastTurn - 1);
}

int AskedTurns::further_samples() const {
  return static_cast<int>(std::ceil(kMostDraws * std::min(1.0, demand_)));
}

double AskedTurns::often_missed() const {
  return share_asked_ + share_avoided_ > 0 ? kTurnsMissed : kOthersMissed;
}

std::vector<NetworkInput> DrawnAgain(const ModelDescription& description, const AskedTurns& turns,
                                     const SynthesisWindow& window, const NetworkInput& input) {
  std::vector<NetworkInput> inputs;
  for (int n = 1; n <= turns.further_samples(); ++n) {
    NetworkInput& again = inputs.emplace_back(input);
    const Sampling& sampling = window.options.sampling;
    again.sampling.seed = CandidateSeed(sampling.seed, sampling.candidates + n - 1);
    const float gain = 1 + (kMostGain - 1) * static_cast<float>(n % kGains + 1) / kGains;
    for (const std::size_t c : TurningIndices(description)) {
      for (std::size_t i = c; i < again.labels.size(); i += description.classes.size()) {
        again.labels[i] *= gain;
      }
    }
  }
  return inputs;
}

std::size_t MostAsAsked(const AskedTurns& turns, const std::vector<std::vector<double>>& samples) {
  double way = 0;
  for (const std::vector<double>& sample : samples) way += turns.Asked(sample);
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
  return candidates + turns.often_missed() * turns.further_samples();
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
