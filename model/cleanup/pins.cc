#include "model/cleanup/pins.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/types/span.h"
#include "model/cleanup/offset_track.h"
#include "model/motion/resample.h"

namespace duet::cleanup {
namespace {

using motion::Pin;
using motion::Pins;
using motion::Vec3;

// How far an arm reaches for a pin before the body moves, in lengths of the arm.
constexpr float kComfortable = 0.95f;
// How far a leg reaches while its foot stands, in lengths of the leg.
constexpr float kLongestReach = 0.998f;
// Metres. A shorter offset has no direction.
constexpr float kNoDirection = 1e-4f;
// Metres. What remains after a swing is corrected on the straight way if it is less: it comes from
// pins between two frames. More remains if the limb does not reach, or has not the time.
constexpr float kCorrectable = 0.02f;
constexpr int kBisections = 8;
// Frames. Pins that are this near concern the body at the same time.
constexpr double kSameTime = 0.5;

// Where a joint is at a time.
Vec3 At(const motion::Poses& poses, const Pin& pin, std::vector<Vec3>* pose) {
  pose->resize(static_cast<std::size_t>(poses.joint_count()));
  SampleCubic(poses, pin.frame, absl::MakeSpan(*pose));
  return (*pose)[static_cast<std::size_t>(pin.joint)];
}
Vec3 At(const motion::Poses& poses, const Pin& pin) {
  std::vector<Vec3> pose;
  return At(poses, pin, &pose);
}

const body::Limb& LimbAt(const body::Body& body, std::size_t index) {
  return index < body.legs.size() ? body.legs[index] : body.arms[index - body.legs.size()];
}
std::size_t LimbCount(const body::Body& body) { return body.legs.size() + body.arms.size(); }
bool IsLeg(const body::Body& body, std::size_t index) { return index < body.legs.size(); }

bool Moves(const body::Limb& limb, int joint) {
  return joint == limb.middle || joint == limb.end ||
         std::find(limb.beyond.begin(), limb.beyond.end(), joint) != limb.beyond.end();
}

// The limb that moves a joint; LimbCount if it is the body.
std::size_t LimbOf(const body::Body& body, int joint) {
  std::size_t index = 0;
  while (index < LimbCount(body) && !Moves(LimbAt(body, index), joint)) ++index;
  return index;
}

bool IsEarlier(const Pin& a, const Pin& b) { return a.frame < b.frame; }

OffsetLimits LimbLimits(const PinOptions& options) {
  return {options.ease_seconds, options.gentle_metres_per_second,
          options.fastest_metres_per_second};
}
OffsetLimits BodyLimits(const PinOptions& options) {
  return {options.ease_seconds, options.gentle_body_metres_per_second,
          options.fastest_body_metres_per_second};
}

void Shift(const std::vector<Vec3>& track, const Timing& timing, motion::Poses* poses) {
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    for (Vec3& joint : (*poses)[t]) joint += track[static_cast<std::size_t>(t)];
  }
}

std::vector<Offset> OffsetsTo(const Pins& pins, const motion::Poses& poses) {
  std::vector<Offset> offsets;
  for (const Pin& pin : pins) offsets.push_back({pin.frame, pin.position - At(poses, pin)});
  return offsets;
}

// `v`, not longer than `most`.
Vec3 Shortened(Vec3 v, double most) {
  const double length = Norm(v);
  return length > most ? v * static_cast<float>(most / length) : v;
}

// The mean of offsets that concern the body at the same time.
std::vector<Offset> Merged(const std::vector<Offset>& offsets) {
  std::vector<Offset> merged;
  for (std::size_t i = 0; i < offsets.size();) {
    Offset sum;
    float count = 0;
    for (const double first = offsets[i].frame;
         i < offsets.size() && offsets[i].frame - first < kSameTime; ++i, ++count) {
      sum.frame += offsets[i].frame;
      sum.way += offsets[i].way;
    }
    merged.push_back({sum.frame / double{count}, sum.way / count});
  }
  return merged;
}

// The way of the body along the floor after which a limb that reaches `share` of its length reaches
// its pin.
Vec3 Shortfall(const body::Limb& limb, float share, const Pin& pin, const motion::Poses& poses) {
  std::vector<Vec3> pose;
  const Vec3 pinned = At(poses, pin, &pose);
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  const float thigh = Distance(at(limb.upper), at(limb.middle));
  const float whole =
      pin.joint == limb.middle ? thigh : thigh + Distance(at(limb.middle), at(limb.end));
  const float reach = share * whole;
  const Vec3 end = pin.joint == limb.middle ? pinned : at(limb.end);
  const Vec3 way = pin.position + (end - pinned) - at(limb.upper), level = {way.x, 0, way.z};
  const float rise = std::abs(way.y);
  const float across = rise < reach ? std::sqrt(reach * reach - rise * rise) : 0;
  if (Norm(level) <= across || Norm(level) < kNoDirection) return {};
  return level * (1 - across / Norm(level));
}

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

// Moves one joint of a limb by `way`. `facing`: of the body.
void MoveJoint(const body::Limb& limb, bool is_leg, int joint, Vec3 way, Vec3 facing,
               absl::Span<Vec3> pose) {
  const auto at = [&](int index) { return pose[static_cast<std::size_t>(index)]; };
  const Vec3 upper = at(limb.upper);
  if (joint == limb.middle) {
    const Vec3 from = at(limb.middle) - upper;
    // A foot stays where it stands.
    if (is_leg) return ReachBent(limb, at(limb.end), from + way, pose);
    return Swing(limb, TurnBetween(from, from + way), pose);
  }
  // Swings before it bends, so that elbow and knee keep their side of the limb.
  const Vec3 goal = at(joint) + way;
  const Turn turn = TurnBetween(at(joint) - upper, goal - upper);
  Swing(limb, turn, pose);
  Reach(limb, at(limb.end) + goal - at(joint), Turned(is_leg ? facing : -facing, turn), pose);
}

Vec3 FacingOf(const motion::Skeleton& skeleton, absl::Span<const Vec3> pose) {
  return skeleton.hips ? body::Facing(*skeleton.hips, pose) : Vec3{};
}

// The part of `way` by which a body can move while its feet stay: all of it unless that takes a leg
// beyond its reach.
float ShareWithFeet(const body::Body& body, Vec3 way, absl::Span<const Vec3> pose) {
  const auto fits = [&](float share) {
    return std::all_of(body.legs.begin(), body.legs.end(), [&](const body::Limb& leg) {
      const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
      const float length =
          Distance(at(leg.upper), at(leg.middle)) + Distance(at(leg.middle), at(leg.end));
      const float now = Distance(at(leg.upper), at(leg.end));
      return Distance(at(leg.upper) + way * share, at(leg.end)) <=
             std::max(now, kLongestReach * length);
    });
  };
  if (fits(1)) return 1;
  float low = 0, high = 1;
  for (int i = 0; i < kBisections; ++i) {
    const float middle = (low + high) / 2;
    (fits(middle) ? low : high) = middle;
  }
  return low;
}

// Moves the body by a track while its feet stay.
void ShiftAboveFeet(const motion::Skeleton& skeleton, const body::Body& body,
                    const std::vector<Vec3>& track, const Timing& timing, motion::Poses* poses) {
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    Vec3 way = track[static_cast<std::size_t>(t)];
    if (Norm(way) < kNoDirection) continue;
    const absl::Span<Vec3> pose = (*poses)[t];
    way = way * ShareWithFeet(body, way, pose);
    std::vector<Vec3> feet;
    for (const body::Limb& leg : body.legs) feet.push_back(pose[static_cast<std::size_t>(leg.end)]);
    for (Vec3& joint : pose) joint += way;
    const Vec3 facing = FacingOf(skeleton, pose);
    for (std::size_t i = 0; i < feet.size(); ++i) Reach(body.legs[i], feet[i], facing, pose);
  }
}

// Turns a limb about its upper joint and changes how far its end is from it, so that the joint of
// `pins` comes to them. On the straight way it could pass through the upper joint.
void SwingToPins(const motion::Skeleton& skeleton, const body::Limb& limb, bool is_leg,
                 const Pins& pins, const OffsetLimits& limits, const Timing& timing,
                 std::vector<bool>* moved, motion::Poses* poses) {
  std::vector<Offset> turns, ranges;
  std::vector<Vec3> pose;
  for (const Pin& pin : pins) {
    const Vec3 now = At(*poses, pin, &pose);
    const Vec3 upper = pose[static_cast<std::size_t>(limb.upper)];
    const float reach = Distance(now, upper), wanted = Distance(pin.position, upper);
    const Turn turn = TurnBetween(now - upper, pin.position - upper);
    // In metres along the circle.
    turns.push_back({pin.frame, turn.axis * (static_cast<float>(turn.radians) * reach)});
    ranges.push_back({pin.frame, {wanted - reach, 0, 0}});
  }
  // Along the circle and towards its middle at the same time.
  constexpr double kShare = 0.7;
  const OffsetLimits both = {limits.ease_seconds, limits.gentle_metres_per_second * kShare,
                             limits.fastest_metres_per_second * kShare};
  const std::vector<Vec3> turn_track = OffsetTrack(turns, both, timing, poses->frame_count());
  const std::vector<Vec3> range_track = OffsetTrack(ranges, both, timing, poses->frame_count());
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    const absl::Span<Vec3> body = (*poses)[t];
    const Vec3 upper = body[static_cast<std::size_t>(limb.upper)];
    const Vec3 from = body[static_cast<std::size_t>(pins.front().joint)] - upper;
    const float angle = Norm(turn_track[at]), reach = Norm(from), longer = range_track[at].x;
    if (reach < kNoDirection || angle + std::abs(longer) < kNoDirection) continue;
    const Turn turn = angle > 0 ? Turn{turn_track[at] / angle, double{angle / reach}} : Turn{};
    const Vec3 to = Turned(from, turn) * (std::max(0.0f, reach + longer) / reach);
    MoveJoint(limb, is_leg, pins.front().joint, to - from, FacingOf(skeleton, body), body);
    (*moved)[at] = true;
  }
}

// Moves the joint of `pins`, all of one joint of a limb, to them.
void MoveToPins(const motion::Skeleton& skeleton, const body::Body& body, std::size_t index,
                const Pins& pins, const OffsetLimits& limits, const Timing& timing,
                std::vector<bool>* moved, motion::Poses* poses) {
  const body::Limb& limb = LimbAt(body, index);
  const bool is_leg = IsLeg(body, index);
  const int joint = pins.front().joint;
  if (joint != limb.middle) {
    SwingToPins(skeleton, limb, is_leg, pins, limits, timing, moved, poses);
  }
  std::vector<Offset> offsets = OffsetsTo(pins, *poses);
  for (Offset& offset : offsets) {
    if (joint != limb.middle && Norm(offset.way) > kCorrectable) offset.way = {};
  }
  const std::vector<Vec3> track = OffsetTrack(offsets, limits, timing, poses->frame_count());
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const Vec3 way = track[static_cast<std::size_t>(t)];
    if (Norm(way) < kNoDirection) continue;
    MoveJoint(limb, is_leg, joint, way, FacingOf(skeleton, (*poses)[t]), (*poses)[t]);
    (*moved)[static_cast<std::size_t>(t)] = true;
  }
}

}  // namespace

PinnedMotion::PinnedMotion(const motion::Skeleton& skeleton, const body::Body& body,
                           const Pins& pins, const PinOptions& options, const Timing& timing,
                           const motion::Poses& follower)
    : timing_(timing),
      skeleton_(skeleton),
      body_(body),
      options_(options),
      limb_pins_(LimbCount(body)) {
  for (Pin pin : pins) {
    if (pin.frame <= timing.settled - 1) continue;
    pin.position = Lerp(pin.position, At(follower, pin), pin.softness);
    pin.softness = 0;
    const std::size_t limb = LimbOf(body, pin.joint);
    (limb < limb_pins_.size() ? limb_pins_[limb] : body_pins_).push_back(pin);
  }
  std::stable_sort(body_pins_.begin(), body_pins_.end(), IsEarlier);
  for (std::size_t i = 0; i < limb_pins_.size(); ++i) {
    const int middle = LimbAt(body, i).middle;
    // The elbow before the hand, which then keeps its side.
    std::stable_sort(limb_pins_[i].begin(), limb_pins_[i].end(),
                     [middle](const Pin& a, const Pin& b) {
                       const bool a_last = a.joint != middle, b_last = b.joint != middle;
                       if (a_last != b_last) return b_last;
                       return a.joint != b.joint ? a.joint < b.joint : IsEarlier(a, b);
                     });
  }
}

bool PinnedMotion::Approach(motion::Poses* follower) const {
  const OffsetLimits limits = BodyLimits(options_);
  const int frames = follower->frame_count();
  std::vector<Offset> offsets = OffsetsTo(body_pins_, *follower);
  for (Offset& offset : offsets) {
    const float lift = options_.farthest_lift_metres;
    offset.way.y = std::clamp(offset.way.y, -lift, lift);
    offset.way = Shortened(offset.way, options_.farthest_body_metres);
  }
  Shift(OffsetTrack(Merged(offsets), limits, timing_, frames), timing_, follower);
  // Where the body is pinned, it stays for the limbs.
  for (Offset& offset : offsets) offset.way = {};
  const std::size_t pinned = offsets.size();
  for (std::size_t i = 0; i < limb_pins_.size(); ++i) {
    for (const Pin& pin : limb_pins_[i]) {
      const float share = IsLeg(body_, i) ? kLongestReach : kComfortable;
      const Vec3 way = Shortened(Shortfall(LimbAt(body_, i), share, pin, *follower),
                                 options_.farthest_approach_metres);
      const bool held = std::any_of(body_pins_.begin(), body_pins_.end(), [&](const Pin& body) {
        return std::abs(body.frame - pin.frame) < kSameTime;
      });
      if (Norm(way) > 0 && !held) offsets.push_back({pin.frame, way});
    }
  }
  if (offsets.size() == pinned) return pinned > 0;
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](const Offset& a, const Offset& b) { return a.frame < b.frame; });
  Shift(OffsetTrack(Merged(offsets), limits, timing_, frames), timing_, follower);
  return true;
}

void PinnedMotion::HoldBody(const motion::Poses& follower) {
  for (Pin& pin : body_pins_) pin.position = At(follower, pin);
}

PinnedMotion::MovedFrames PinnedMotion::Place(motion::Poses* follower) const {
  const int frames = follower->frame_count();
  if (!body_pins_.empty()) {
    const std::vector<Offset> offsets = Merged(OffsetsTo(body_pins_, *follower));
    ShiftAboveFeet(skeleton_, body_, OffsetTrack(offsets, BodyLimits(options_), timing_, frames),
                   timing_, follower);
  }
  MovedFrames moved(limb_pins_.size());
  for (std::size_t i = 0; i < limb_pins_.size(); ++i) {
    moved[i].resize(static_cast<std::size_t>(frames));
    const Pins& pins = limb_pins_[i];
    for (auto first = pins.begin(); first != pins.end();) {
      const auto end = std::find_if(first, pins.end(),
                                    [first](const Pin& pin) { return pin.joint != first->joint; });
      MoveToPins(skeleton_, body_, i, Pins(first, end), LimbLimits(options_), timing_, &moved[i],
                 follower);
      first = end;
    }
  }
  return moved;
}

double MeanPinDistance(const Pins& pins, const motion::Poses& follower, int settled) {
  double sum = 0;
  int count = 0;
  for (const Pin& pin : pins) {
    if (pin.frame <= settled - 1 || pin.frame > follower.frame_count() - 1) continue;
    sum += double{Distance(At(follower, pin), pin.position)};
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace duet::cleanup
