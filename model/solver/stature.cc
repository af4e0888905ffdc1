#include "model/solver/stature.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/motion/filter.h"
#include "model/solver/smoother.h"

namespace duet::solver {
namespace {

using motion::Vec3;

// The time over which corrections of the height come and go. Seconds.
constexpr double kRiseSeconds = 0.1;
constexpr double kNear = 0.02;
// A correction of settled frames costs this much more than one that is not wished for.
constexpr double kSettled = 1e6;
// A foot that moves less stands. m/s.
constexpr double kStanding = 0.15;
// The part of a leg's length that it may reach.
constexpr float kReach = 0.998f;
// What is longer than a dip: the deviation of a Gaussian. Seconds.
constexpr double kLastingSeconds = 0.35;

Vec3 At(absl::Span<const Vec3> pose, int joint) { return pose[static_cast<std::size_t>(joint)]; }

float Stretch(const body::Limb& leg, absl::Span<const Vec3> pose) {
  const float length = body::LengthOf(leg, pose);
  return length > 0 ? Distance(At(pose, leg.upper), At(pose, leg.end)) / length : 1;
}

float MeanLength(const std::vector<body::Limb>& legs, absl::Span<const Vec3> pose) {
  return (body::LengthOf(legs[0], pose) + body::LengthOf(legs[1], pose)) / 2;
}

class Stature {
 public:
  Stature(const std::vector<body::Limb>& legs, const Stretches& wanted,
          const StatureOptions& options, motion::Poses* poses)
      : legs_(legs), wanted_(wanted), options_(options), poses_(*poses) {}

  void Run() {
    const std::vector<double> lacks = LastingLacks();
    std::vector<double> weights, wishes;
    for (int t = 0; t < poses_.frame_count(); ++t) {
      double weight = 0, sum = 0;
      for (std::size_t leg = 0; leg < 2; ++leg) {
        if (!Stands(leg, t)) continue;
        weight += 1;
        sum += RiseFor(leg, t, std::min(kReach, wanted_[leg][static_cast<std::size_t>(t)]));
      }
      const double lack = lacks[static_cast<std::size_t>(t)];
      double wish = weight > 0 ? sum / weight : 0;
      if (lack > 0) wish = std::max(wish, lack);
      weights.push_back(t < options_.settled ? kSettled : std::max(weight, 0.1));
      wishes.push_back(t < options_.settled ? 0 : wish);
    }
    const std::vector<double> rises =
        SmoothCorrection({options_.frame_rate_hz, kRiseSeconds, kNear}, weights, wishes);
    for (int t = options_.settled; t < poses_.frame_count(); ++t) {
      Raise(std::min(static_cast<float>(rises[static_cast<std::size_t>(t)]), Room(t)), t);
    }
  }

 private:
  bool Stands(std::size_t leg, int t) const {
    const int foot = legs_[leg].end;
    const int before = std::max(0, t - 1), after = std::min(poses_.frame_count() - 1, t + 1);
    const double way = Distance(poses_.at(before, foot), poses_.at(after, foot));
    return way * options_.frame_rate_hz <= kStanding * std::max(1, after - before);
  }

  // The rise at which a leg is stretched to a share of its length.
  float RiseFor(std::size_t leg, int t, float stretch) const {
    const Vec3 way = At(poses_[t], legs_[leg].upper) - At(poses_[t], legs_[leg].end);
    const float length = stretch * body::LengthOf(legs_[leg], poses_[t]);
    return std::sqrt(std::max(0.0f, length * length - way.x * way.x - way.z * way.z)) - way.y;
  }
  // How far the body can rise until a leg is as long as it gets; at least 0.
  float Room(int t) const {
    return std::max(0.0f, std::min(RiseFor(0, t, kReach), RiseFor(1, t, kReach)));
  }

  // What lasting hip heights lack, metres.
  std::vector<double> LastingLacks() const {
    std::vector<double> lacks;
    const std::vector<float> heights = LastingHipHeights(legs_, poses_, options_.frame_rate_hz);
    for (int t = 0; t < poses_.frame_count(); ++t) {
      const double lack = options_.least_height - heights[static_cast<std::size_t>(t)];
      lacks.push_back(std::max(0.0, lack) * MeanLength(legs_, poses_[t]));
    }
    return lacks;
  }

  // Raises the body above its feet.
  void Raise(float by, int t) {
    const absl::Span<Vec3> pose = poses_[t];
    const Vec3 feet[] = {At(pose, legs_[0].end), At(pose, legs_[1].end)};
    const Vec3 facing = body::Facing({legs_[0].upper, legs_[1].upper}, pose);
    for (Vec3& joint : pose) joint.y += by;
    for (std::size_t leg = 0; leg < 2; ++leg) body::Reach(legs_[leg], feet[leg], facing, pose);
  }

  const std::vector<body::Limb>& legs_;
  const Stretches& wanted_;
  const StatureOptions& options_;
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

std::vector<float> LastingHipHeights(const std::vector<body::Limb>& legs,
                                     const motion::Poses& poses, double frame_rate_hz) {
  motion::Poses heights(poses.frame_count(), 1);
  for (int t = 0; t < poses.frame_count(); ++t) {
    const absl::Span<const Vec3> pose = poses[t];
    const float hips = (At(pose, legs[0].upper).y + At(pose, legs[1].upper).y) / 2;
    const float lower = std::min(At(pose, legs[0].end).y, At(pose, legs[1].end).y);
    const float length = MeanLength(legs, pose);
    heights.at(t, 0).y = length > 0 ? (hips - lower) / length : 1;
  }
  heights = motion::GaussianFilter(heights, kLastingSeconds * frame_rate_hz);
  std::vector<float> lasting;
  for (const Vec3 height : heights.all()) lasting.push_back(height.y);
  return lasting;
}

void KeepStature(const std::vector<body::Limb>& legs, const Stretches& wanted,
                 const StatureOptions& options, motion::Poses* poses) {
  if (legs.size() != 2 || poses->frame_count() == 0) return;
  Stature(legs, wanted, options, poses).Run();
}

}  // namespace duet::solver
