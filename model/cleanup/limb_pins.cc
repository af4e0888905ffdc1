#include "model/cleanup/limb_pins.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "absl/types/span.h"
#include "model/cleanup/directions.h"
#include "model/cleanup/pinned_joint.h"

namespace duet::cleanup {
namespace {

using motion::Pin;
using motion::Pins;
using motion::Vec3;

// Metres. What remains after a swing is corrected on the straight way if it is less: it comes from
// pins between two frames. More remains if the limb does not reach, or has not the time.
constexpr float kCorrectable = 0.02f;
// Cosine of the smallest angle between the bones of a limb: a flexion of 155 degrees
// (JointRangeOptions::folded).
constexpr float kFoldedCosine = 0.906f;
// How far a pinned limb stretches, in lengths of the limb.
constexpr float kStretched = 0.999f;
// A correction that is faster than the limit by more than this is approached less, by this factor.
constexpr float kTolerance = 1.1f, kLess = 0.7f;
// Rounds in which the fastest pin is approached less, and then in which all are.
constexpr int kSingleRounds = 16, kCommonRounds = 12;

// The shortest rotation from one direction to another.
struct Turn {
  Vec3 axis;  // of length 1
  double radians = 0;
};

Turn TurnBetween(Vec3 from, Vec3 to) {
  const Vec3 axis = Cross(from, to);
  const float sine = Norm(axis);
  if (sine < 1e-9f) return {};
  return {axis / sine, std::atan2(double{sine}, double{Dot(from, to)})};
}

Vec3 Turned(Vec3 v, const Turn& turn) {
  return turn.radians == 0 ? v : RotateAbout(v, turn.axis, turn.radians);
}

// Rotates a whole limb about its upper joint.
void Swing(const body::Limb& limb, const Turn& turn, absl::Span<Vec3> pose) {
  const Vec3 upper = pose[static_cast<std::size_t>(limb.upper)];
  const auto swing = [&](int joint) {
    Vec3& position = pose[static_cast<std::size_t>(joint)];
    position = upper + Turned(position - upper, turn);
  };
  swing(limb.middle);
  swing(limb.end);
  for (const int joint : limb.beyond) swing(joint);
}

// Moves one joint of a limb by `way`.
void MoveJoint(const PinnedLimb& pinned, int joint, Vec3 way, absl::Span<Vec3> pose) {
  const body::Limb& limb = pinned.limb;
  const auto at = [&](int index) { return pose[static_cast<std::size_t>(index)]; };
  const Vec3 upper = at(limb.upper);
  if (joint == limb.middle) {
    const Vec3 from = at(limb.middle) - upper;
    // A foot stays where it stands.
    if (pinned.is_leg) return ReachBent(limb, at(limb.end), from + way, pose);
    return Swing(limb, TurnBetween(from, from + way), pose);
  }
  // Swings before it bends, so that elbow and knee keep their side of the limb.
  const Vec3 facing = FacingOf(pinned.skeleton, pose);
  const Vec3 goal = at(joint) + way;
  const Turn turn = TurnBetween(at(joint) - upper, goal - upper);
  Swing(limb, turn, pose);
  Reach(limb, at(limb.end) + goal - at(joint), Turned(pinned.is_leg ? facing : -facing, turn),
        pose);
}

// How near to its upper joint a limb's end comes, and how far from it.
struct ReachRange {
  float least = 0;
  float most = 0;
};

ReachRange RangeOf(const body::Limb& limb, absl::Span<const Vec3> pose) {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  const float a = Distance(at(limb.upper), at(limb.middle));
  const float b = Distance(at(limb.middle), at(limb.end));
  return {std::sqrt(std::max(0.0f, a * a + b * b - 2 * a * b * kFoldedCosine)),
          kStretched * (a + b)};
}

// How far a joint is from the upper joint of its limb while that is within its range.
float WithinRange(const body::Limb& limb, int joint, float wanted, float now,
                  absl::Span<const Vec3> pose) {
  // Joints beyond the end are somewhat farther.
  if (joint != limb.end) return wanted;
  const ReachRange range = RangeOf(limb, pose);
  return std::clamp(wanted, std::min(range.least, now), std::max(range.most, now));
}

// Turns a limb about its upper joint and changes how far its end is from it, so that the joint of
// `pins` comes to them.
void SwingToPins(const PinnedLimb& pinned, const Pins& pins, const Timing& timing,
                 std::vector<bool>* moved, motion::Poses* poses) {
  const body::Limb& limb = pinned.limb;
  const int joint = pins.front().joint;
  std::vector<Offset> turns, ranges;
  std::vector<Vec3> pose;
  for (const Pin& pin : pins) {
    const Vec3 now = JointAt(*poses, pin, &pose);
    const Vec3 upper = pose[static_cast<std::size_t>(limb.upper)];
    const float reach = Distance(now, upper), away = Distance(pin.position, upper);
    const float wanted = WithinRange(limb, joint, away, reach, pose);
    Turn turn = TurnBetween(now - upper, pin.position - upper);
    // A pin in the upper joint has no direction.
    if (away < wanted) turn.radians *= double{SmoothStep(double{away / wanted})};
    // In metres along the circle.
    turns.push_back({pin.frame, turn.axis * (static_cast<float>(turn.radians) * reach)});
    ranges.push_back({pin.frame, {wanted - reach, 0, 0}});
  }
  // Along the circle and towards its middle at the same time.
  constexpr double kShare = 0.7;
  const OffsetLimits both = {pinned.limits.ease_seconds,
                             pinned.limits.gentle_metres_per_second * kShare,
                             pinned.limits.fastest_metres_per_second * kShare};
  const std::vector<Vec3> turn_track = OffsetTrack(turns, both, timing, poses->frame_count());
  const std::vector<Vec3> range_track = OffsetTrack(ranges, both, timing, poses->frame_count());
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    const absl::Span<Vec3> body = (*poses)[t];
    const Vec3 upper = body[static_cast<std::size_t>(limb.upper)];
    const Vec3 from = body[static_cast<std::size_t>(joint)] - upper;
    const float angle = Norm(turn_track[at]), reach = Norm(from), longer = range_track[at].x;
    if (reach < kNoDirection || angle + std::abs(longer) < kNoDirection) continue;
    const Turn turn = angle > 0 ? Turn{turn_track[at] / angle, double{angle / reach}} : Turn{};
    const float to = WithinRange(limb, joint, reach + longer, reach, body);
    MoveJoint(pinned, joint, Turned(from, turn) * (std::max(0.0f, to) / reach) - from, body);
    (*moved)[at] = true;
  }
}

// Moves the joint of `pins`, all of one joint, to them.
void MoveJointToPins(const PinnedLimb& pinned, const Pins& pins, const Timing& timing,
                     std::vector<bool>* moved, motion::Poses* poses) {
  const int joint = pins.front().joint;
  const bool swings = joint != pinned.limb.middle;
  if (swings) SwingToPins(pinned, pins, timing, moved, poses);
  std::vector<Offset> offsets = OffsetsTo(pins, *poses);
  for (Offset& offset : offsets) {
    if (swings && Norm(offset.way) > kCorrectable) offset.way = {};
  }
  const std::vector<Vec3> track = OffsetTrack(offsets, pinned.limits, timing, poses->frame_count());
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const Vec3 way = track[static_cast<std::size_t>(t)];
    if (Norm(way) < kNoDirection) continue;
    MoveJoint(pinned, joint, way, (*poses)[t]);
    (*moved)[static_cast<std::size_t>(t)] = true;
  }
}

std::vector<int> JointsOf(const body::Limb& limb) {
  std::vector<int> joints = limb.beyond;
  joints.insert(joints.end(), {limb.middle, limb.end});
  return joints;
}

void CopyJoints(const std::vector<int>& joints, int frame, const motion::Poses& from,
                motion::Poses* to) {
  for (const int joint : joints) to->at(frame, joint) = from.at(frame, joint);
}

// The limb at its pins, without a limit for its speed.
motion::Poses Moved(const PinnedLimb& pinned, const Pins& pins, const KeepRanges& keep_ranges,
                    const Timing& timing, const motion::Poses& poses) {
  motion::Poses result = poses;
  std::vector<bool> moved(static_cast<std::size_t>(poses.frame_count()));
  for (auto first = pins.begin(); first != pins.end();) {
    const auto end = std::find_if(first, pins.end(),
                                  [first](const Pin& pin) { return pin.joint != first->joint; });
    MoveJointToPins(pinned, Pins(first, end), timing, &moved, &result);
    first = end;
  }
  if (!keep_ranges) return result;
  motion::Poses ranged = result;
  keep_ranges(&ranged);
  const std::vector<int> joints = JointsOf(pinned.limb);
  for (int t = timing.settled; t < poses.frame_count(); ++t) {
    if (moved[static_cast<std::size_t>(t)]) CopyJoints(joints, t, ranged, &result);
  }
  return result;
}

// The frame in which the limb is fastest because of its correction, relative to its upper joint, if
// that is faster than its limit; -1 otherwise.
int TooFastFrame(const PinnedLimb& pinned, const motion::Poses& before, const motion::Poses& after,
                 const Timing& timing) {
  const body::Limb& limb = pinned.limb;
  const auto added = [&](int t, int joint) {
    return (after.at(t, joint) - after.at(t, limb.upper)) -
           (before.at(t, joint) - before.at(t, limb.upper));
  };
  double fastest = pinned.limits.fastest_metres_per_second * double{kTolerance};
  int frame = -1;
  for (int t = std::max(1, timing.settled); t < after.frame_count(); ++t) {
    for (const int joint : {limb.middle, limb.end}) {
      const double speed =
          double{Distance(added(t, joint), added(t - 1, joint))} * timing.frame_rate_hz;
      if (speed <= fastest) continue;
      fastest = speed;
      frame = t;
    }
  }
  return frame;
}

// The pin that is nearest in time to the way from one frame to `frame`.
std::size_t NearestPin(const Pins& pins, int frame) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < pins.size(); ++i) {
    const auto off = [&](std::size_t pin) { return std::abs(pins[pin].frame - (frame - 0.5)); };
    if (off(i) < off(nearest)) nearest = i;
  }
  return nearest;
}

}  // namespace

bool MovesWith(const body::Limb& limb, int joint) {
  return joint == limb.middle || joint == limb.end ||
         std::find(limb.beyond.begin(), limb.beyond.end(), joint) != limb.beyond.end();
}

void MoveToPins(const PinnedLimb& limb, const Pins& pins, const KeepRanges& keep_ranges,
                const Timing& timing, motion::Poses* poses) {
  if (pins.empty()) return;
  Pins approached = pins;
  for (int round = 0; round < kSingleRounds + kCommonRounds; ++round) {
    motion::Poses moved = Moved(limb, approached, keep_ranges, timing, *poses);
    const int frame = TooFastFrame(limb, *poses, moved, timing);
    if (frame < 0) {
      *poses = std::move(moved);
      return;
    }
    const std::size_t fastest = NearestPin(approached, frame);
    for (std::size_t i = 0; i < approached.size(); ++i) {
      if (i != fastest && round < kSingleRounds) continue;
      Pin& pin = approached[i];
      pin.position = Lerp(JointAt(*poses, pin), pin.position, kLess);
    }
  }
}

}  // namespace duet::cleanup
