#include "model/cleanup/steps_in_time.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "model/motion/resample.h"
#include "model/motion/steps.h"

namespace duet::cleanup {
namespace {

constexpr double kFarthestSeconds = 0.3;  // that a step is moved
constexpr double kReachSeconds = 0.2;     // deviation of the Gaussian around a step that is moved
constexpr double kStill = 0.3;            // the weight of not moving
// How far a frame must be beyond the one before, as a fraction of a frame.
constexpr double kLeastAdvance = 0.4;

struct MovedStep {
  double frame = 0;
  double by = 0;  // frames
};

// Only the feet, as FindSteps reads no other joint.
std::vector<double> StepsOf(const motion::JointPair& feet, const motion::Poses& person,
                            double frame_rate_hz) {
  motion::Poses ankles(person.frame_count(), 2);
  for (int t = 0; t < person.frame_count(); ++t) {
    ankles.at(t, 0) = person.at(t, feet.left);
    ankles.at(t, 1) = person.at(t, feet.right);
  }
  return motion::FindSteps({0, 1}, ankles, frame_rate_hz);
}

std::vector<MovedStep> StepsToMove(const std::vector<double>& steps,
                                   const std::vector<double>& leaders, double frame_rate_hz) {
  std::vector<MovedStep> moved;
  for (const double step : steps) {
    const auto nearest = std::min_element(
        leaders.begin(), leaders.end(),
        [step](double a, double b) { return std::abs(a - step) < std::abs(b - step); });
    if (nearest == leaders.end() || std::abs(*nearest - step) > kFarthestSeconds) continue;
    moved.push_back({step * frame_rate_hz, (*nearest - step) * frame_rate_hz});
  }
  return moved;
}

// By how many frames the motion around a frame is later: the mean of the steps nearby.
double ShiftAt(int frame, const std::vector<MovedStep>& steps, const Timing& timing) {
  double sum = 0, weights = kStill;
  for (const MovedStep& step : steps) {
    const double away = (frame - step.frame) / timing.Frames(kReachSeconds);
    const double weight = std::exp(-0.5 * away * away);
    sum += weight * step.by;
    weights += weight;
  }
  return sum / weights;
}

}  // namespace

void StepInTime(const motion::JointPair& feet, const motion::Poses& leader, const Timing& timing,
                motion::Poses* follower) {
  const std::vector<MovedStep> steps =
      StepsToMove(StepsOf(feet, *follower, timing.frame_rate_hz),
                  StepsOf(feet, leader, timing.frame_rate_hz), timing.frame_rate_hz);
  if (steps.empty()) return;
  const motion::Poses before = *follower;
  const int last = before.frame_count() - 1;
  double source = std::max(0, timing.settled - 1);
  for (int t = timing.settled; t < last; ++t) {
    const double ends = SmoothStep((last - t) / (timing.Frames(timing.ease_seconds) + 1));
    const double shift = double{EaseIn(timing, t)} * ends * ShiftAt(t, steps, timing);
    source = std::min<double>(last, std::max(source + kLeastAdvance, t - shift));
    if (t == 0) source = 0;
    SampleCubic(before, source, (*follower)[t]);
  }
}

}  // namespace duet::cleanup
