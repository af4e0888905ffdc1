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
constexpr float kMostGain = 4;
constexpr int kGains = 4;  // different gains, evenly up to the largest

// The direction of a person's hips against the line to the partner, degrees; jumps by whole turns.
double Direction(const motion::JointPair& hips, int root, const motion::Poses& person,
                 const motion::Poses& partner, int frame) {
  const motion::Vec3 across = person.at(frame, hips.left) - person.at(frame, hips.right);
  const motion::Vec3 line = partner.at(frame, root) - person.at(frame, root);
  return (std::atan2(across.z, across.x) - std::atan2(line.z, line.x)) / base::kRadiansPerDegree;
}

// How far the person turns from one frame to the next, degrees.
double TurnedAt(const motion::JointPair& hips, int root, const motion::Poses& person,
                const motion::Poses& partner, int frame) {
  const double turned = Direction(hips, root, person, partner, frame) -
                        Direction(hips, root, person, partner, frame - 1);
  return turned - 360 * std::round(turned / 360);
}

// The largest turn in one direction, with or without pauses and small turns back.
class TurnedRange {
 public:
  void Add(double degrees) {
    at_ += degrees;
    lowest_ = std::min(lowest_, at_);
    highest_ = std::max(highest_, at_);
  }
  double degrees() const { return highest_ - lowest_; }

 private:
  double at_ = 0, lowest_ = 0, highest_ = 0;
};

}  // namespace

AskedTurns::AskedTurns(const ModelDescription& description, const SynthesisWindow& window) {
  if (description.turning_classes.empty() || !description.skeleton.hips) return;
  root_ = description.skeleton.root;
  hips_ = *description.skeleton.hips;
  first_ = std::max(1, SettledFrames(window));
  const int end = window.leader.frame_count() - description.lookahead_frames;
  if (end <= first_) return;
  wanted_.resize(static_cast<std::size_t>(end - first_));
  const auto& classes = description.classes;
  double asked = 0, avoided = 0;
  for (const TurningClass& turning : description.turning_classes) {
    const std::size_t c = static_cast<std::size_t>(
        std::find(classes.begin(), classes.end(), turning.interaction_class) - classes.begin());
    for (std::size_t i = 0; i < wanted_.size() && c < classes.size(); ++i) {
      const std::size_t frame = static_cast<std::size_t>(first_) + i;
      const double weight =
          std::clamp(double{window.labels[frame * classes.size() + c]}, -1.0, 1.0);
      wanted_[i] += weight * turning.degrees_per_second / description.frame_rate_hz;
      (weight > 0 ? asked : avoided) += std::abs(weight);
    }
  }
  for (const double wanted : wanted_) (wanted > 0 ? asked_ : avoided_) += std::abs(wanted);
  share_asked_ = asked / static_cast<double>(wanted_.size());
  share_avoided_ = avoided / static_cast<double>(wanted_.size());
  demand_ = share_asked_ + share_avoided_;
  if (demand_ < kLeastDemand) demand_ = 0;
}

double AskedTurns::Miss(const motion::Poses& leader, const motion::Poses& follower) const {
  if (demand_ == 0) return 0;
  TurnedRange asked, avoided;
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    if (wanted_[i] == 0) continue;
    const double turned = TurnedAt(hips_, root_, follower, leader, first_ + static_cast<int>(i));
    (wanted_[i] > 0 ? asked : avoided).Add(turned);
  }
  double miss = 0;
  if (asked_ > 0) {
    miss += share_asked_ * std::max(0.0, 1 - asked.degrees() / (kEnoughSpeed * asked_));
  }
  if (avoided_ > 0) {
    miss += share_avoided_ * std::max(0.0, avoided.degrees() - kFreeDegrees) / kLeastTurn;
  }
  return miss;
}

std::vector<NetworkInput> DrawnAgain(const ModelDescription& description, const AskedTurns& turns,
                                     const SynthesisWindow& window, const NetworkInput& input) {
  const auto& classes = description.classes;
  std::vector<NetworkInput> inputs;
  const int count = static_cast<int>(std::ceil(kMostDraws * std::min(1.0, turns.demand())));
  for (int n = 1; n <= count; ++n) {
    NetworkInput& again = inputs.emplace_back(input);
    const Sampling& sampling = window.options.sampling;
    again.sampling.seed = CandidateSeed(sampling.seed, sampling.candidates + n - 1);
    const float gain = 1 + (kMostGain - 1) * static_cast<float>(n % kGains + 1) / kGains;
    for (const TurningClass& turning : description.turning_classes) {
      const std::size_t c = static_cast<std::size_t>(
          std::find(classes.begin(), classes.end(), turning.interaction_class) - classes.begin());
      for (std::size_t i = c; i < again.labels.size(); i += classes.size()) {
        again.labels[i] *= gain;
      }
    }
  }
  return inputs;
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
