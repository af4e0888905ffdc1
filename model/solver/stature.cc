#include "model/solver/stature.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/motion/filter.h"
#include "model/solver/geometry.h"
#include "model/solver/smoother.h"

namespace duet::solver {
namespace {

using motion::Vec3;

// The time over which corrections of the height come and go. Seconds.
constexpr double kRiseSeconds = 0.1;
constexpr double kNear = 0.02;
// The weight of frames in which no foot stands.
constexpr double kIdle = 0.1;
// The part of a leg's length that it may reach.
constexpr float kReach = 0.998f;
// Lasting hip heights are at least this, in lengths of the leg. Captured people stand at .96 on
// average, dancers at .92.
constexpr double kLeastHeight = 0.9;
// The body comes down to its standing feet as far as this, in lengths of the leg. A foot that it
// would have to come down further for leaves its place: people who are thrown back lose their stand
// and do not sit down. Captured people's hips are lower in 1 of 1000 frames.
constexpr float kDeepest = 0.7f;
// What is longer than a dip: the deviation of a Gaussian. Seconds.
constexpr double kLastingSeconds = 0.35;

float Stretch(const body::Limb& leg, absl::Span<const Vec3> pose) {
  const float length = body::LengthOf(leg, pose);
  return length > 0 ? Distance(JointAt(pose, leg.upper), JointAt(pose, leg.end)) / length : 1;
}

float MeanLength(const std::vector<body::Limb>& legs, absl::Span<const Vec3> pose) {
  return (body::LengthOf(legs[0], pose) + body::LengthOf(legs[1], pose)) / 2;
}

class Stature {
 public:
  Stature(const std::vector<body::Limb>& legs, const Footing& footing, const Stretches& wanted,
          double frame_rate_hz, int given, motion::Poses* poses)
      : legs_(legs),
        footing_(footing),
        wanted_(wanted),
        frame_rate_hz_(frame_rate_hz),
        given_(given),
        poses_(*poses) {}

  void Run() {
    const std::vector<double> lacks = LastingLacks();
    std::vector<double> weights, wishes;
    for (int t = 0; t < poses_.frame_count(); ++t) {
      double weight = 0, sum = 0;
      for (std::size_t leg = 0; leg < 2; ++leg) {
        if (!footing_.standing[leg][static_cast<std::size_t>(t)]) continue;
        weight += 1;
        sum += RiseFor(leg, t, std::min(kReach, wanted_[leg][static_cast<std::size_t>(t)]));
      }
      const double wish = weight > 0 ? sum / weight : 0;
      weights.push_back(std::max(weight, kIdle));
      wishes.push_back(std::max(wish, lacks[static_cast<std::size_t>(t)]));
    }
    const std::vector<double> rises =
        SmoothCorrection({frame_rate_hz_, kRiseSeconds, kNear, given_}, weights, wishes);
    for (int t = given_; t < poses_.frame_count(); ++t) {
      const float rise = std::min(static_cast<float>(rises[static_cast<std::size_t>(t)]), Room(t));
      const float deepest = kDeepest * MeanLength(legs_, poses_[t]) - HipsAboveFoot(t);
      const float bounded = std::max(rise, std::min(0.0f, deepest));
      for (Vec3& joint : poses_[t]) joint.y += bounded;
    }
  }

 private:
  // The rise at which a leg is stretched to a share of its length above its planned foot.
  float RiseFor(std::size_t leg, int t, float stretch) const {
    const Vec3 way =
        JointAt(poses_[t], legs_[leg].upper) - footing_.paths[leg][static_cast<std::size_t>(t)];
    const float length = stretch * body::LengthOf(legs_[leg], poses_[t]);
    return std::sqrt(std::max(0.0f, length * length - way.x * way.x - way.z * way.z)) - way.y;
  }
  // How far the body can rise until a leg is as long as it gets; below 0 if it must come down.
  // A foot that swings need not be reached while the other one stands.
  float Room(int t) const {
    const std::size_t at = static_cast<std::size_t>(t);
    const float left = RiseFor(0, t, kReach), right = RiseFor(1, t, kReach);
    if (footing_.standing[0][at] == footing_.standing[1][at]) return std::min(left, right);
    return footing_.standing[0][at] ? left : right;
  }

  // The height of the hips above the lower planned foot, metres.
  float HipsAboveFoot(int t) const {
    const std::size_t at = static_cast<std::size_t>(t);
    const float hips =
        (JointAt(poses_[t], legs_[0].upper).y + JointAt(poses_[t], legs_[1].upper).y) / 2;
    return hips - std::min(footing_.paths[0][at].y, footing_.paths[1][at].y);
  }

  // How far the hips are below the least lasting height, metres.
  std::vector<double> LastingLacks() const {
    motion::Poses heights(poses_.frame_count(), 1);  // in lengths of the leg
    for (int t = 0; t < poses_.frame_count(); ++t) {
      const float length = MeanLength(legs_, poses_[t]);
      heights.at(t, 0).y = length > 0 ? HipsAboveFoot(t) / length : 1;
    }
    heights = motion::GaussianFilter(heights, kLastingSeconds * frame_rate_hz_);
    std::vector<double> lacks;
    for (int t = 0; t < poses_.frame_count(); ++t) {
      const double lack = kLeastHeight - double{heights.at(t, 0).y};
      lacks.push_back(std::max(0.0, lack) * MeanLength(legs_, poses_[t]));
    }
    return lacks;
  }

  const std::vector<body::Limb>& legs_;
  const Footing& footing_;
  const Stretches& wanted_;
  double frame_rate_hz_;
  int given_;
  motion::Poses& poses_;
};

}  // namespace

Stretches MeasureStretches(const std::vector<body::Limb>& legs, const motion::Poses& poses) {
  Stretches stretches;
  for (const body::Limb& leg : legs) {
    stretches.emplace_back();
    for (int t = 0; t < poses.frame_count(); ++t) {
      stretches.back().push_back(Stretch(leg, poses[t]));
    }
  }
  return stretches;
}

void KeepStature(const std::vector<body::Limb>& legs, const Footing& footing,
                 const Stretches& wanted, double frame_rate_hz, int given, motion::Poses* poses) {
  Stature(legs, footing, wanted, frame_rate_hz, given, poses).Run();
}

}  // namespace duet::solver
