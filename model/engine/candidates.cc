#include "model/engine/candidates.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/body/contact.h"
#include "model/body/grade.h"
#include "model/engine/windows.h"
#include "model/solver/pins.h"

namespace duet::engine {
namespace {

using motion::Poses;

// What one unit of each fault costs.
constexpr double kTwistCost = 1.0;    // a frame twisted by twice the threshold
constexpr double kOverlapCost = 4.0;  // a frame in which heads or trunks overlap by 10 cm
constexpr double kSkateCost = 0.1;    // a frame in which the slower ankle moves at 1 m/s
constexpr double kHandCost = 4.0;     // hands that are to meet and are one metre apart
constexpr double kPinCost = 2.0;      // a pin that is one metre away, on average of all pins
constexpr double kCriticCost = 0.1;   // odds of being captured that are lower by the factor e
// Degrees between shoulders and hips from which on a twist counts.
constexpr double kFreeTwistDegrees = 30;

double FaultOf(const body::FrameMeasures& frame) {
  const double twist = std::max(0.0, frame.twist_degrees - kFreeTwistDegrees) / body::kTwistDegrees;
  const double skate = std::clamp(frame.skate - body::kSkateMetresPerSecond, 0.0, 1.0);
  return kTwistCost * twist * twist +
         kOverlapCost * 10 * (frame.head_overlap + frame.trunk_overlap) + kSkateCost * skate;
}

}  // namespace

int CandidateCount(const ModelDescription& model, const Sampling& sampling) {
  return model.samples ? sampling.candidates : 1;
}

int EvaluationCount(const ModelDescription& model, const Sampling& sampling) {
  return CandidateCount(model, sampling) * (model.labels_guide && sampling.reaction != 1 ? 2 : 1);
}

uint64_t CandidateSeed(uint64_t seed, int n) {
  // Windows count upwards, so candidates count downwards from the same stream.
  return WindowSeed(seed, -n);
}

CandidateJudge::CandidateJudge(const motion::Skeleton& skeleton, std::optional<Critic> critic)
    : skeleton_(skeleton), body_(body::FindBody(skeleton)), critic_(std::move(critic)) {}

double CandidateJudge::Faults(const Poses& leader, const Poses& follower, int settled,
                              double frame_rate_hz) const {
  if (!body::PairMeter::CanMeasure(skeleton_, body_)) return 0;
  body::PairMeter meter(skeleton_, body_, frame_rate_hz);
  double faults = 0;
  for (int t = std::max(0, settled - 1); t < follower.frame_count(); ++t) {
    const body::FrameMeasures frame = meter.Add(leader[t], follower[t]);
    if (t >= settled) faults += FaultOf(frame);
  }
  return faults / std::max(1, follower.frame_count() - settled);
}

double CandidateJudge::HandsApart(const Poses& leader, const Poses& follower, int settled,
                                  const solver::ContactRules& rules) const {
  if (!body_.shoulders) return 0;
  double sum = 0;
  for (int t = settled; t < follower.frame_count(); ++t) {
    const solver::ContactRule& rule = rules[static_cast<std::size_t>(t)];
    if (rule.hands == 0) continue;
    const std::optional<double> apart =
        body::OfferedHandDistance(body_, skeleton_.root, leader[t], follower[t]);
    sum += double{rule.hands} * std::max(0.0, apart.value_or(0) - double{rule.hands_metres});
  }
  return sum / std::max(1, follower.frame_count() - settled);
}

int CandidateJudge::Best(const Poses& leader, const std::vector<Poses>& followers, int settled,
                         double frame_rate_hz, const motion::Pins& pins,
                         const solver::ContactRules& rules, absl::Span<const float> labels) const {
  if (followers.size() == 1) return 0;
  std::vector<double> costs(followers.size());
  for (std::size_t i = 0; i < followers.size(); ++i) {
    costs[i] = Faults(leader, followers[i], settled, frame_rate_hz);
    if (!rules.empty()) {
      costs[i] += kHandCost * HandsApart(leader, followers[i], settled, rules);
    }
    if (critic_) costs[i] -= kCriticCost * double{critic_->Score(leader, followers[i], labels)};
    if (!pins.empty()) costs[i] += kPinCost * solver::MeanPinDistance(pins, followers[i], settled);
  }
  return static_cast<int>(std::min_element(costs.begin(), costs.end()) - costs.begin());
}

}  // namespace duet::engine
