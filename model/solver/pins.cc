#include "model/solver/pins.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "model/motion/resample.h"
#include "model/solver/geometry.h"
#include "model/solver/smoother.h"

namespace duet::solver {
namespace {

using motion::Pin;
using motion::Pins;
using motion::Vec3;

// The time over which the body, and a limb, come to a pin and leave it; longer ways take longer, so
// that they are not faster than the speed. Seconds, m/s.
constexpr double kBodySeconds = 0.3, kLimbSeconds = 0.15;
constexpr double kBodySpeed = 1.5, kLimbSpeed = 3;
// Where there is less time after the given frames, a joint does not come all the way. m/s.
constexpr double kFastestBody = 1.5, kFastestLimb = 2.5;
// The weights of a pin and of not correcting; corrections that are smaller than the last are none.
// Metres.
constexpr double kPinned = 1e5, kNear = 1;
constexpr float kNoWay = 5e-4f;
// How far an arm reaches for a pin before the body moves, and any limb, in its lengths.
constexpr float kComfortable = 0.95f, kReach = 0.998f;
// How far the body rises or sinks for a pin at most: people can crouch or stand on their toes.
constexpr float kMostLift = 0.3f;
// Passes over a limb: a limb turns on a circle, so that one straight correction falls short.
constexpr int kRounds = 5;
// Steps of the search for the share of a way.
constexpr int kBisections = 8;

Vec3 PinnedJoint(const motion::Poses& poses, const Pin& pin) {
  const int before = std::clamp(static_cast<int>(pin.frame), 0, poses.frame_count() - 1);
  const int after = std::min(before + 1, poses.frame_count() - 1);
  const float share = static_cast<float>(std::clamp(pin.frame - before, 0.0, 1.0));
  return Lerp(poses.at(before, pin.joint), poses.at(after, pin.joint), share);
}

Vec3 FacingOf(const motion::Skeleton& skeleton, absl::Span<const Vec3> pose) {
  return skeleton.hips ? body::Facing(*skeleton.hips, pose) : Vec3{0, 0, 1};
}

// The part of a way for which there is time since the given frames.
Vec3 InTime(Vec3 way, const Pin& pin, int given, double fastest, double rate) {
  const double most = fastest * (pin.frame - given + 1) / rate, length = double{Norm(way)};
  return given > 0 && length > most ? way * static_cast<float>(most / length) : way;
}

// The part of a way of the body on which its legs still reach their feet, or get no farther from
// reaching them.
float ShareWithinReach(const std::vector<body::Limb>& legs, Vec3 way, absl::Span<const Vec3> pose) {
  const auto reaches = [&](float share) {
    return std::all_of(legs.begin(), legs.end(), [&](const body::Limb& leg) {
      const Vec3 hip = JointAt(pose, leg.upper), foot = JointAt(pose, leg.end);
      const float most = std::max(Distance(hip, foot), kReach * body::LengthOf(leg, pose));
      return Distance(hip + way * share, foot) <= most;
    });
  };
  float low = 0, high = 1;
  if (reaches(1)) return 1;
  for (int i = 0; i < kBisections; ++i) {
    const float middle = (low + high) / 2;
    (reaches(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

PinnedBody::PinnedBody(const motion::Skeleton& skeleton, const body::Body& body, const Pins& pins,
                       double frame_rate_hz, int given, const motion::Poses& follower)
    : skeleton_(skeleton), body_(body), frame_rate_hz_(frame_rate_hz), given_(given) {
  for (const body::Limb& leg : body.legs) limbs_.push_back({&leg, true, {}});
  for (const body::Limb& arm : body.arms) limbs_.push_back({&arm, false, {}});
  for (Pin pin : pins) {
    if (pin.frame <= given - 1) continue;
    pin.position = Lerp(pin.position, PinnedJoint(follower, pin), pin.softness);
    Pins* of = &body_pins_;
    for (LimbPins& limb : limbs_) {
      if (pin.joint == limb.limb->middle || pin.joint == limb.limb->end ||
          Contains(limb.limb->beyond, pin.joint)) {
        of = &limb.pins;
      }
    }
    of->push_back(pin);
  }
}

std::vector<Vec3> PinnedBody::Track(const Pins& pins, const std::vector<Vec3>& ways, double seconds,
                                    int frames) const {
  // A pin that comes after the window is prepared for: the correction goes on to it.
  double last = frames - 1;
  for (const Pin& pin : pins) last = std::max(last, std::ceil(pin.frame));
  std::vector<double> weights(static_cast<std::size_t>(last) + 1);
  std::vector<Vec3> sums(weights.size());
  for (std::size_t i = 0; i < pins.size(); ++i) {
    for (const double t : {std::floor(pins[i].frame), std::ceil(pins[i].frame)}) {
      weights[static_cast<std::size_t>(t)] += kPinned;
      sums[static_cast<std::size_t>(t)] += ways[i];
    }
  }
  for (std::size_t t = 0; t < sums.size(); ++t) {
    if (weights[t] > 0) sums[t] = sums[t] * static_cast<float>(kPinned / weights[t]);
  }
  std::vector<Vec3> track = SmoothShift({frame_rate_hz_, seconds, kNear, given_}, weights, sums);
  track.resize(static_cast<std::size_t>(frames));
  return track;
}

std::vector<Vec3> PinnedBody::Track(const Pins& pins, double seconds,
                                    const motion::Poses& follower) const {
  std::vector<Vec3> ways;
  for (const Pin& pin : pins) ways.push_back(pin.position - PinnedJoint(follower, pin));
  return Track(pins, ways, seconds, follower.frame_count());
}

Pins PinnedBody::InTimeOf(Pins pins, double fastest, const motion::Poses& follower) const {
  for (Pin& pin : pins) {
    const Vec3 from = PinnedJoint(follower, pin);
    pin.position = from + InTime(pin.position - from, pin, given_, fastest, frame_rate_hz_);
  }
  return pins;
}

void PinnedBody::Approach(motion::Poses* follower) const {
  Pins pins = body_pins_;
  std::vector<Vec3> ways;
  double farthest = 0;
  for (const Pin& pin : pins) {
    Vec3 way = pin.position - PinnedJoint(*follower, pin);
    way.y = std::clamp(way.y, -kMostLift, kMostLift);
    ways.push_back(InTime(way, pin, given_, kFastestBody, frame_rate_hz_));
  }
  for (const LimbPins& pinned : limbs_) {
    for (const Pin& pin : pinned.pins) {
      const bool held = std::any_of(body_pins_.begin(), body_pins_.end(), [&](const Pin& other) {
        return std::abs(other.frame - pin.frame) < 0.5;
      });
      if (held) continue;
      const int t =
          std::clamp(static_cast<int>(std::lround(pin.frame)), 0, follower->frame_count() - 1);
      const Vec3 way = pin.position - follower->at(t, pinned.limb->upper);
      const float reach =
          (pinned.is_leg ? kReach : kComfortable) * body::LengthOf(*pinned.limb, (*follower)[t]);
      const float rise = std::min(std::abs(way.y), reach);
      const float across = std::sqrt(reach * reach - rise * rise);
      const float lacks = std::max(0.0f, Norm(Level(way)) - across);
      pins.push_back(pin);
      ways.push_back(InTime(Unit(Level(way)) * lacks, pin, given_, kFastestBody, frame_rate_hz_));
    }
  }
  for (const Vec3 way : ways) farthest = std::max(farthest, double{Norm(way)});
  if (farthest == 0) return;
  const double seconds = std::max(kBodySeconds, farthest / kBodySpeed);
  const std::vector<Vec3> track = Track(pins, ways, seconds, follower->frame_count());
  for (int t = given_; t < follower->frame_count(); ++t) {
    const Vec3 way = track[static_cast<std::size_t>(t)];
    if (Norm(way) < kNoWay) continue;
    for (Vec3& joint : (*follower)[t]) joint += way;
  }
}

void PinnedBody::MoveJoint(const LimbPins& pinned, int joint, Vec3 way,
                           absl::Span<Vec3> pose) const {
  const body::Limb& limb = *pinned.limb;
  const Vec3 upper = JointAt(pose, limb.upper), from = JointAt(pose, joint) - upper;
  const Vec3 bend = body::BendOf(limb, pose);
  if (joint == limb.middle && pinned.is_leg) {
    return body::ReachBent(limb, JointAt(pose, limb.end), from + way, pose);
  }
  if (joint != limb.middle) {
    const Vec3 facing = FacingOf(skeleton_, pose);
    const Vec3 side = Norm(bend) > kNoDirection ? bend : pinned.is_leg ? facing : -facing;
    return body::ReachBent(limb, JointAt(pose, limb.end) + way, side, pose);
  }
  const Vec3 axis = Unit(Cross(from, from + way));
  if (axis == Vec3{}) return;
  const double angle = AngleAbout(axis, from, from + way);
  const auto turn = [&](int moved) {
    Vec3& position = pose[static_cast<std::size_t>(moved)];
    position = upper + RotateAbout(position - upper, axis, angle);
  };
  turn(limb.middle);
  turn(limb.end);
  for (const int beyond : limb.beyond) turn(beyond);
}

void PinnedBody::Place(motion::Poses* follower) const {
  if (!body_pins_.empty()) {
    const Pins in_time = InTimeOf(body_pins_, kFastestBody, *follower);
    const std::vector<Vec3> track = Track(in_time, kBodySeconds, *follower);
    for (int t = given_; t < follower->frame_count(); ++t) {
      const absl::Span<Vec3> pose = (*follower)[t];
      Vec3 way = track[static_cast<std::size_t>(t)];
      if (Norm(way) < kNoWay) continue;
      way = way * ShareWithinReach(body_.legs, way, pose);
      std::vector<Vec3> feet;
      for (const body::Limb& leg : body_.legs) feet.push_back(JointAt(pose, leg.end));
      for (Vec3& joint : pose) joint += way;
      const Vec3 facing = FacingOf(skeleton_, pose);
      for (std::size_t leg = 0; leg < feet.size(); ++leg) {
        body::Reach(body_.legs[leg], feet[leg], facing, pose);
      }
    }
  }
  for (const LimbPins& pinned : limbs_) {
    // An elbow before its hand, which then keeps the elbow's side.
    for (const bool middle : {true, false}) {
      Pins pins;
      for (const Pin& pin : pinned.pins) {
        if ((pin.joint == pinned.limb->middle) == middle) pins.push_back(pin);
      }
      pins = InTimeOf(std::move(pins), kFastestLimb, *follower);
      for (int round = 0; round < kRounds && !pins.empty(); ++round) {
        double farthest = 0;
        for (const Pin& pin : pins) {
          farthest =
              std::max(farthest, double{Distance(pin.position, PinnedJoint(*follower, pin))});
        }
        const double seconds = std::max(kLimbSeconds, farthest / kLimbSpeed);
        const std::vector<Vec3> track = Track(pins, seconds, *follower);
        for (int t = given_; t < follower->frame_count(); ++t) {
          const Vec3 way = track[static_cast<std::size_t>(t)];
          if (Norm(way) >= kNoWay) MoveJoint(pinned, pins[0].joint, way, (*follower)[t]);
        }
      }
    }
  }
}

double MeanPinDistance(const Pins& pins, const motion::Poses& follower, int given) {
  double sum = 0;
  int count = 0;
  for (const Pin& pin : pins) {
    if (pin.frame <= given - 1 || pin.frame > follower.frame_count() - 1) continue;
    sum += double{Distance(PinnedJoint(follower, pin), pin.position)};
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace duet::solver
