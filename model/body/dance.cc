#include "model/body/dance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/base/angle.h"
#include "model/base/statistics.h"
#include "model/motion/filter.h"
#include "model/motion/steps.h"

namespace duet::body {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kLeastTurn = 230, kTurnRate = 45, kPauseSeconds = 0.3;  // degrees
constexpr double kMostDelaySeconds = 1.5;
constexpr double kHeldMetres = 0.28;
constexpr double kMovingSpeed = 0.15;

double Degrees(double radians) { return radians * 180 / base::kPi; }

// Adds whole turns so that no step is larger than half a turn.
void Unwrap(std::vector<double>* angles) {
  for (std::size_t i = 1; i < angles->size(); ++i) {
    (*angles)[i] += 360 * std::round(((*angles)[i - 1] - (*angles)[i]) / 360);
  }
}

// The direction of a person's hips against the line to the partner, degrees, without jumps.
std::vector<double> Directions(const DanceJoints& joints, const motion::Poses& person,
                               const motion::Poses& partner) {
  std::vector<double> across, line;
  for (int t = 0; t < person.frame_count(); ++t) {
    const motion::Vec3 hips = person.at(t, joints.hips.left) - person.at(t, joints.hips.right);
    const motion::Vec3 between = partner.at(t, joints.root) - person.at(t, joints.root);
    across.push_back(Degrees(std::atan2(hips.z, hips.x)));
    line.push_back(Degrees(std::atan2(between.z, between.x)));
  }
  Unwrap(&across);
  Unwrap(&line);
  for (std::size_t t = 0; t < across.size(); ++t) across[t] -= line[t];
  return across;
}

// Stretches [begin, end) of frames, joined across pauses.
using Stretch = std::pair<int, int>;
template <typename Predicate>
std::vector<Stretch> Stretches(int frames, double pause, Predicate holds) {
  std::vector<Stretch> found;
  for (int t = 0; t < frames; ++t) {
    if (!holds(t)) continue;
    if (found.empty() || t - found.back().second >= std::max(pause, 1.0)) found.emplace_back(t, t);
    found.back().second = t + 1;
  }
  return found;
}

struct Wrists {
  int leader = 0, follower = 0;
  double metres = 0;
};
Wrists NearestWrists(const DanceJoints& joints, const motion::Poses& leader,
                     const motion::Poses& follower, int frame) {
  Wrists nearest{0, 0, std::numeric_limits<double>::infinity()};
  for (const int a : {joints.wrists.left, joints.wrists.right}) {
    for (const int b : {joints.wrists.left, joints.wrists.right}) {
      const double metres = Distance(leader.at(frame, a), follower.at(frame, b));
      if (metres < nearest.metres) nearest = {a, b, metres};
    }
  }
  return nearest;
}

}  // namespace

absl::StatusOr<DanceJoints> FindDanceJoints(const motion::Skeleton& skeleton) {
  const auto lacks = [](const std::string& what) {
    return absl::InvalidArgumentError(absl::StrCat("skeleton: expected ", what, ", got none"));
  };
  if (!skeleton.hips) return lacks("hips");
  if (!skeleton.feet) return lacks("feet");
  const std::optional<motion::JointPair> hands = motion::FindHands(skeleton);
  if (!hands) return lacks("joints left_wrist and right_wrist, or left_hand and right_hand");
  return DanceJoints{skeleton.root, *skeleton.hips, *skeleton.feet, *hands};
}

std::vector<Turn> FindTurns(const DanceJoints& joints, const motion::Poses& person,
                            const motion::Poses& partner, double frame_rate_hz) {
  const std::vector<double> angle =
      Directions(joints, WithoutNoise(person, frame_rate_hz), WithoutNoise(partner, frame_rate_hz));
  std::vector<Turn> turns;
  for (const double way : {1.0, -1.0}) {
    const auto rotates = [&](int t) {
      const auto now = static_cast<std::size_t>(t);
      return t > 0 && way * (angle[now] - angle[now - 1]) * frame_rate_hz > kTurnRate;
    };
    for (const auto& [begin, end] :
         Stretches(person.frame_count(), kPauseSeconds * frame_rate_hz, rotates)) {
      const double degrees =
          angle[static_cast<std::size_t>(end - 1)] - angle[static_cast<std::size_t>(begin - 1)];
      if (std::abs(degrees) >= kLeastTurn) {
        turns.push_back({begin / frame_rate_hz, end / frame_rate_hz, degrees});
      }
    }
  }
  std::sort(turns.begin(), turns.end(),
            [](const Turn& a, const Turn& b) { return a.begin < b.begin; });
  return turns;
}

TurnMatch MatchTurns(const std::vector<Turn>& captured, const std::vector<Turn>& turns) {
  std::vector<double> delays;
  for (const Turn& original : captured) {
    double nearest = kMostDelaySeconds;
    bool found = false;
    for (const Turn& turn : turns) {
      const double delay = std::abs(turn.middle() - original.middle());
      if ((turn.degrees > 0) != (original.degrees > 0) || delay > nearest) continue;
      nearest = delay;
      found = true;
    }
    if (found) delays.push_back(nearest);
  }
  return {static_cast<int>(delays.size()), base::Mean(delays)};
}

Holds MeasureHolds(const DanceJoints& joints, const motion::Poses& leader,
                   const motion::Poses& follower, double frame_rate_hz) {
  const int frames = follower.frame_count();
  std::vector<Wrists> nearest;
  nearest.reserve(static_cast<std::size_t>(frames));
  for (int t = 0; t < frames; ++t) nearest.push_back(NearestWrists(joints, leader, follower, t));
  const auto is_held = [&](int t) {
    return nearest[static_cast<std::size_t>(t)].metres < kHeldMetres;
  };
  double held = 0;
  std::vector<double> slips;
  const std::vector<Stretch> holds = Stretches(frames, 1, is_held);
  for (const auto& [begin, end] : holds) {
    held += end - begin;
    for (int t = begin + 1; t < end; ++t) {
      const Wrists& wrists = nearest[static_cast<std::size_t>(t)];
      const auto offset = [&](int frame) {
        return follower.at(frame, wrists.follower) - leader.at(frame, wrists.leader);
      };
      slips.push_back(Norm(offset(t) - offset(t - 1)) * frame_rate_hz);
    }
  }
  if (holds.empty()) return {0, kNone, kNone};
  return {held / frames, held / static_cast<double>(holds.size()) / frame_rate_hz,
          base::Mean(slips)};
}

double BothFeetMove(const DanceJoints& joints, const motion::Poses& person, double frame_rate_hz) {
  const motion::Poses calm = WithoutNoise(person, frame_rate_hz);
  int moving = 0;
  for (int t = 1; t < calm.frame_count(); ++t) {
    moving += motion::SpeedAt(calm, t, joints.feet.left, frame_rate_hz) > kMovingSpeed &&
              motion::SpeedAt(calm, t, joints.feet.right, frame_rate_hz) > kMovingSpeed;
  }
  return calm.frame_count() < 2 ? kNone : static_cast<double>(moving) / (calm.frame_count() - 1);
}

double MeanError(const motion::Poses& made, const motion::Poses& captured) {
  double sum = 0;
  for (std::size_t i = 0; i < captured.all().size(); ++i) {
    sum += Distance(made.all()[i], captured.all()[i]);
  }
  return captured.all().empty() ? kNone : sum / static_cast<double>(captured.all().size());
}

}  // namespace duet::body
