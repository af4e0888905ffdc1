#include "model/solver/trunk.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/types/span.h"
#include "model/base/angle.h"
#include "model/motion/filter.h"
#include "model/solver/geometry.h"
#include "model/solver/smoother.h"

namespace duet::solver {
namespace {

using base::kRadiansPerDegree;
using motion::Vec3;

constexpr Vec3 kUp{0, 1, 0};
// People turn their shoulders against their hips by up to 40 degrees without effort.
constexpr double kMostTwist = 40 * kRadiansPerDegree;
// How far the lines of the hips and of the shoulders may be from across the trunk.
constexpr double kMostTilt = 18 * kRadiansPerDegree;
// How far the head may be bent against the trunk.
constexpr double kMostNeck = 70 * kRadiansPerDegree;
// The mean lean over about half a second. Captured people lean farther only in passing.
constexpr double kMostLeanDegrees = 12;
constexpr double kLeanSeconds = 0.45;
// The part of a lean above the feet that the hips leave; the trunk leaves the rest.
constexpr float kHipsShare = 0.6f;
// The time over which corrections come and go, and the weight of not correcting.
constexpr double kTurnSeconds = 0.15, kLeanCorrectionSeconds = 0.15, kNear = 0.02;
// The weight of frames that need no correction.
constexpr double kIdle = 0.1;
// Each round corrects what the smooth correction of the one before left.
constexpr int kRounds = 2;

double Excess(double angle, double most) { return angle - std::clamp(angle, -most, most); }

// The correction of angles that exceed a limit.
std::vector<double> Corrections(const std::vector<double>& excesses, double seconds,
                                double frame_rate_hz, int given) {
  std::vector<double> weights, wishes;
  for (const double excess : excesses) {
    weights.push_back(excess != 0 ? 1 : kIdle);
    wishes.push_back(-excess);
  }
  return SmoothCorrection({frame_rate_hz, seconds, kNear, given}, weights, wishes);
}

// Moves a leg along with its hip, and its foot back to where it was, as far as it reaches.
void LetFootStay(const body::Limb& leg, absl::Span<const Vec3> old, absl::Span<Vec3> pose) {
  const Vec3 way = JointAt(pose, leg.upper) - JointAt(old, leg.upper);
  for (const int joint : {leg.middle, leg.end}) pose[static_cast<std::size_t>(joint)] += way;
  for (const int joint : leg.beyond) pose[static_cast<std::size_t>(joint)] += way;
  body::ReachBent(leg, JointAt(old, leg.end), body::BendOf(leg, old), pose);
}

// The smallest change of a vector's angle to the vertical that takes it to at most `most`.
Vec3 LeanExcess(Vec3 v, double most) {
  const float across = std::hypot(v.x, v.z);
  const float allowed = static_cast<float>(std::tan(most)) * std::max(v.y, 0.2f);
  return across > allowed ? Level(v) * (1 - allowed / across) : Vec3{};
}

}  // namespace

Trunk::Trunk(const motion::Skeleton& skeleton, const body::Body& body)
    : skeleton_(skeleton), body_(body), arms_(body.arms) {
  if (arms_[0].upper != body.shoulders->left) std::swap(arms_[0], arms_[1]);
  for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
    above_legs_.push_back(std::none_of(body.legs.begin(), body.legs.end(), [&](const auto& leg) {
      return joint == leg.middle || joint == leg.end || Contains(leg.beyond, joint);
    }));
  }
}

Vec3 Trunk::HipsMiddle(absl::Span<const Vec3> pose) const {
  return Lerp(JointAt(pose, skeleton_.hips->left), JointAt(pose, skeleton_.hips->right), 0.5f);
}

void Trunk::TurnLine(const motion::JointPair& pair, const std::vector<body::Limb>& limbs, Vec3 axis,
                     double radians, absl::Span<Vec3> pose) const {
  const Vec3 middle = Lerp(JointAt(pose, pair.left), JointAt(pose, pair.right), 0.5f);
  for (const body::Limb& limb : limbs) {
    const Vec3 from = JointAt(pose, limb.upper);
    const Vec3 way = middle + RotateAbout(from - middle, axis, radians) - from;
    for (const int joint : {limb.upper, limb.middle, limb.end}) {
      pose[static_cast<std::size_t>(joint)] += way;
    }
    for (const int joint : limb.beyond) pose[static_cast<std::size_t>(joint)] += way;
  }
}

void Trunk::LimitTwist(double frame_rate_hz, int given, motion::Poses* poses) const {
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> excesses;
    std::vector<Vec3> axes;
    double last = 0;
    for (int t = 0; t < poses->frame_count(); ++t) {
      const absl::Span<const Vec3> pose = (*poses)[t];
      axes.push_back(Unit(JointAt(pose, *body_.chest) - HipsMiddle(pose)));
      const auto line = [&](const motion::JointPair& pair) {
        return JointAt(pose, pair.left) - JointAt(pose, pair.right);
      };
      const double twist = AngleAbout(axes.back(), line(*body_.shoulders), line(*skeleton_.hips));
      // A body that is turned over once is turned back the same way in all frames.
      last += std::remainder(twist - last, 2 * base::kPi);
      excesses.push_back(Excess(last, kMostTwist));
    }
    const std::vector<double> turns = Corrections(excesses, kTurnSeconds, frame_rate_hz, given);
    for (int t = given; t < poses->frame_count(); ++t) {
      const std::size_t at = static_cast<std::size_t>(t);
      TurnLine(*skeleton_.hips, body_.legs, axes[at], turns[at], (*poses)[t]);
    }
  }
  LimitTilt(frame_rate_hz, given, poses);
  LimitNeck(frame_rate_hz, given, poses);
}

void Trunk::LimitTilt(double frame_rate_hz, int given, motion::Poses* poses) const {
  const struct {
    const motion::JointPair& pair;
    const std::vector<body::Limb>& limbs;
  } lines[] = {{*skeleton_.hips, body_.legs}, {*body_.shoulders, arms_}};
  for (const auto& line : lines) {
    std::vector<double> excesses;
    std::vector<Vec3> axes;
    for (int t = 0; t < poses->frame_count(); ++t) {
      const absl::Span<const Vec3> pose = (*poses)[t];
      const Vec3 trunk = Unit(JointAt(pose, *body_.chest) - HipsMiddle(pose));
      const Vec3 across = Unit(JointAt(pose, line.pair.left) - JointAt(pose, line.pair.right));
      // Rotating about this axis raises the left joint towards the trunk's direction.
      axes.push_back(Unit(Cross(across, trunk)));
      const double sine = std::clamp(double{Dot(across, trunk)}, -1.0, 1.0);
      excesses.push_back(Excess(std::asin(sine), kMostTilt));
    }
    const std::vector<double> turns = Corrections(excesses, kTurnSeconds, frame_rate_hz, given);
    for (int t = given; t < poses->frame_count(); ++t) {
      const std::size_t at = static_cast<std::size_t>(t);
      TurnLine(line.pair, line.limbs, axes[at], turns[at], (*poses)[t]);
    }
  }
}

void Trunk::LimitNeck(double frame_rate_hz, int given, motion::Poses* poses) const {
  if (!body_.neck) return;
  std::vector<double> excesses;
  std::vector<Vec3> axes;
  for (int t = 0; t < poses->frame_count(); ++t) {
    const absl::Span<const Vec3> pose = (*poses)[t];
    const Vec3 trunk = Unit(JointAt(pose, *body_.chest) - HipsMiddle(pose));
    const Vec3 head = Unit(JointAt(pose, body_.neck->head) - JointAt(pose, body_.neck->base));
    axes.push_back(Unit(Cross(trunk, head)));
    const double angle = std::acos(std::clamp(double{Dot(trunk, head)}, -1.0, 1.0));
    excesses.push_back(Excess(angle, kMostNeck));
  }
  const std::vector<double> turns = Corrections(excesses, kTurnSeconds, frame_rate_hz, given);
  for (int t = given; t < poses->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    const Vec3 base = poses->at(t, body_.neck->base);
    for (const int joint : body_.neck->branch) {
      Vec3& position = poses->at(t, joint);
      position = base + RotateAbout(position - base, axes[at], turns[at]);
    }
  }
}

double Trunk::LeanDegrees(const motion::Poses& poses, int frame) const {
  const Vec3 trunk = poses.at(frame, *body_.chest) - HipsMiddle(poses[frame]);
  return std::atan2(std::hypot(trunk.x, trunk.z), trunk.y) * base::kDegreesPerRadian;
}

void Trunk::LimitLean(double frame_rate_hz, int given, double own_degrees,
                      motion::Poses* poses) const {
  const int frames = poses->frame_count();
  const double most = std::max(kMostLeanDegrees, own_degrees) * kRadiansPerDegree;
  for (int round = 0; round < kRounds; ++round) {
    motion::Poses leans(frames, 2);  // of the trunk above the hips, and above the feet
    for (int t = 0; t < frames; ++t) {
      const Vec3 chest = poses->at(t, *body_.chest);
      const Vec3 feet =
          Lerp(poses->at(t, body_.legs[0].end), poses->at(t, body_.legs[1].end), 0.5f);
      leans.at(t, 0) = chest - HipsMiddle((*poses)[t]);
      leans.at(t, 1) = chest - feet;
    }
    leans = motion::GaussianFilter(leans, kLeanSeconds * frame_rate_hz);
    std::vector<Vec3> hips, chests;
    std::vector<double> weights;
    for (int t = 0; t < frames; ++t) {
      const Vec3 above_feet = LeanExcess(leans.at(t, 1), most);
      hips.push_back(-above_feet * kHipsShare);
      chests.push_back(-above_feet * (1 - kHipsShare) - LeanExcess(leans.at(t, 0), most));
      weights.push_back(Norm(hips.back()) + Norm(chests.back()) > 0 ? 1 : kIdle);
    }
    const CorrectionCost cost{frame_rate_hz, kLeanCorrectionSeconds, kNear, given};
    hips = SmoothShift(cost, weights, hips);
    chests = SmoothShift(cost, weights, chests);
    for (int t = given; t < frames; ++t) {
      const std::size_t at = static_cast<std::size_t>(t);
      const absl::Span<Vec3> pose = (*poses)[t];
      const Vec3 middle = HipsMiddle(pose);
      const Vec3 from = JointAt(pose, *body_.chest) - middle, to = from + chests[at];
      const Vec3 axis = Unit(Cross(from, to));
      const double angle = axis == Vec3{} ? 0 : AngleAbout(axis, from, to);
      const std::vector<Vec3> old(pose.begin(), pose.end());
      for (std::size_t joint = 0; joint < pose.size(); ++joint) {
        if (!above_legs_[joint]) continue;
        if (angle != 0) pose[joint] = middle + RotateAbout(pose[joint] - middle, axis, angle);
        pose[joint] += hips[at];
      }
      for (const body::Limb& leg : body_.legs) LetFootStay(leg, old, pose);
    }
  }
}

}  // namespace duet::solver
