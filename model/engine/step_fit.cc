#include "model/engine/step_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/statistics.h"
#include "model/motion/steps.h"

namespace duet::engine {
namespace {

constexpr double kSameStepSeconds = 0.5;  // steps farther apart do not belong together
constexpr double kMostSpread = 0.9;       // of that of chance
constexpr std::size_t kFewestSteps = 100;
// In a shorter clip, the beginning and the end of the interaction decide when people step.
constexpr double kFewestSeconds = 10;
constexpr double kOtherTimes[] = {0.25, 0.5, 0.75};  // of the pair's length

void AddOffsets(const std::vector<double>& steps, const std::vector<double>& times,
                std::vector<double>* offsets) {
  for (const double step : steps) {
    const auto nearest = std::min_element(times.begin(), times.end(), [step](double a, double b) {
      return std::abs(a - step) < std::abs(b - step);
    });
    if (nearest == times.end() || std::abs(*nearest - step) > kSameStepSeconds) continue;
    offsets->push_back(*nearest - step);
  }
}

}  // namespace

void StepFit::Add(const motion::Poses& leader, const motion::Poses& follower) {
  if (!skeleton_.feet || leader.frame_count() < kFewestSeconds * frame_rate_hz_) return;
  const std::vector<double> leaders = FindSteps(*skeleton_.feet, leader, frame_rate_hz_),
                            steps = FindSteps(*skeleton_.feet, follower, frame_rate_hz_);
  AddOffsets(steps, leaders, &captured_);
  const double seconds = leader.frame_count() / frame_rate_hz_;
  for (const double share : kOtherTimes) {
    std::vector<double> moved = leaders;
    for (double& time : moved) time = std::fmod(time + share * seconds, seconds);
    AddOffsets(steps, moved, &chance_);
  }
}

bool StepFit::InTime() const {
  if (captured_.size() < kFewestSteps || chance_.size() < kFewestSteps) return false;
  return base::Summarise(captured_).deviation <= kMostSpread * base::Summarise(chance_).deviation;
}

}  // namespace duet::engine
