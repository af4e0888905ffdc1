#include "model/training/reaction_pace.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/angle.h"
#include "model/motion/filter.h"

namespace duet::training {
namespace {

using motion::Poses;

// The shake of a capture is no action.
constexpr double kSmoothingSeconds = 0.3;
// Mean speeds of the joints of a leader who rests, and of one who acts, metres per second.
constexpr double kRestingSpeed = 0.08, kActingSpeed = 0.2;
// The pace of the way back.
constexpr double kRecoveryPace = 0.7;
// A follower that has recovered goes through the first part of its motion, to and fro.
constexpr double kSwaySeconds = 0.4, kSwayPeriodSeconds = 5;
// The share of the followers that begin in the midst of the reaction.
constexpr double kMidstShare = 0.5;

}  // namespace

std::vector<double> ActingShares(const Poses& leader, double frame_rate_hz) {
  const Poses smooth = motion::GaussianFilter(leader, kSmoothingSeconds * frame_rate_hz);
  std::vector<double> shares;
  for (int t = 0; t < smooth.frame_count(); ++t) {
    const int next = std::min(t + 1, smooth.frame_count() - 1), last = std::max(next - 1, 0);
    double moved = 0;
    for (int j = 0; j < smooth.joint_count(); ++j) {
      moved += Distance(smooth.at(next, j), smooth.at(last, j));
    }
    const double speed = moved * frame_rate_hz / smooth.joint_count();
    shares.push_back(
        std::clamp((speed - kRestingSpeed) / (kActingSpeed - kRestingSpeed), 0.0, 1.0));
  }
  return shares;
}

std::vector<double> ReactionFrames(const std::vector<double>& acting_shares, int first, int frames,
                                   double frame_rate_hz, base::Random* random) {
  const double end = frames - 1;
  double at = random->Chance(kMidstShare) ? random->Uniform(0, end) : 0;
  double direction = 1;
  const double phase = random->Uniform(0, 2 * base::kPi);
  std::vector<double> reached;
  for (int t = 0; t < frames; ++t) {
    const double turn = phase + 2 * base::kPi * t / (kSwayPeriodSeconds * frame_rate_hz);
    const double sway = kSwaySeconds * frame_rate_hz * 0.5 * (1 - std::cos(turn));
    const double acts = acting_shares[static_cast<std::size_t>(first + t)];
    const double acting_pace = direction > 0 ? 1 : -kRecoveryPace;
    if (t > 0) at += acts * acting_pace - (1 - acts) * kRecoveryPace;
    if (at >= end) direction = -1;
    if (at <= sway) direction = 1;
    at = std::clamp(at, std::min(sway, end), end);
    reached.push_back(at);
  }
  return reached;
}

}  // namespace duet::training
