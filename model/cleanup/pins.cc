#include "model/cleanup/pins.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/types/span.h"
#include "model/cleanup/directions.h"
#include "model/cleanup/offset_track.h"
#include "model/cleanup/pinned_joint.h"

namespace duet::cleanup {
namespace {

using motion::Pin;
using motion::Pins;
using motion::Vec3;

// How far an arm reaches for a pin before the body moves, in lengths of the arm.
constexpr float kComfortable = 0.95f;
// How far a leg reaches while its foot stands, in lengths of the leg.
constexpr float kLongestReach = 0.998f;
constexpr int kBisections = 8;
// Frames. Pins that are this near concern the body at the same time.
constexpr double kSameTime = 0.5;

const body::Limb& LimbAt(const body::Body& body, std::size_t index) {
  return index < body.legs.size() ? body.legs[index] : body.arms[index - body.legs.size()];
}
std::size_t LimbCount(const body::Body& body) { return body.legs.size() + body.arms.size(); }
bool IsLeg(const body::Body& body, std::size_t index) { return index < body.legs.size(); }

// The limb that moves a joint; LimbCount if it is the body.
std::size_t LimbOf(const body::Body& body, int joint) {
  std::size_t index = 0;
  while (index < LimbCount(body) && !MovesWith(LimbAt(body, index), joint)) ++index;
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
  const Vec3 pinned = JointAt(poses, pin, &pose);
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

// How far the heel of a foot rises while the leg of `hip` and the foot's place is stretched; more
// than `highest` if the leg does not reach it then.
float HeelRise(Vec3 hip, Vec3 foot, float length, float highest) {
  const Vec3 way = foot - hip;
  const float across = Norm(Vec3{way.x, 0, way.z}), reach = kLongestReach * length;
  if (across >= reach) return 2 * highest;
  return std::max(0.0f, -way.y - std::sqrt(reach * reach - across * across));
}

// The part of `way` by which a body can move while its feet stay in their places and their heels
// rise by at most `highest`: all of it unless that takes a leg beyond its reach.
float ShareWithFeet(const body::Body& body, Vec3 way, float highest, absl::Span<const Vec3> pose) {
  const auto fits = [&](float share) {
    return std::all_of(body.legs.begin(), body.legs.end(), [&](const body::Limb& leg) {
      const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
      const Vec3 hip = at(leg.upper) + way * share;
      if (Distance(hip, at(leg.end)) <= Distance(at(leg.upper), at(leg.end))) return true;
      return HeelRise(hip, at(leg.end), LengthOf(leg, pose), highest) <= highest;
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

// Moves the body by a track while its feet stay in their places. A heel rises where its leg would
// not reach the foot otherwise.
void ShiftAboveFeet(const motion::Skeleton& skeleton, const body::Body& body,
                    const std::vector<Vec3>& track, float highest_heel, const Timing& timing,
                    motion::Poses* poses) {
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    Vec3 way = track[static_cast<std::size_t>(t)];
    if (Norm(way) < kNoDirection) continue;
    const absl::Span<Vec3> pose = (*poses)[t];
    way = way * ShareWithFeet(body, way, highest_heel, pose);
    std::vector<Vec3> feet;
    for (const body::Limb& leg : body.legs) {
      const Vec3 foot = pose[static_cast<std::size_t>(leg.end)];
      const Vec3 hip = pose[static_cast<std::size_t>(leg.upper)] + way;
      const float rise = HeelRise(hip, foot, LengthOf(leg, pose), highest_heel);
      feet.push_back(foot + Vec3{0, std::min(rise, highest_heel), 0});
    }
    for (Vec3& joint : pose) joint += way;
    const Vec3 facing = FacingOf(skeleton, pose);
    for (std::size_t i = 0; i < feet.size(); ++i) Reach(body.legs[i], feet[i], facing, pose);
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
    pin.position = Lerp(pin.position, JointAt(follower, pin), pin.softness);
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
  for (Pin& pin : body_pins_) pin.position = JointAt(follower, pin);
}

void PinnedMotion::Place(const KeepRanges& keep_ranges, motion::Poses* follower) const {
  if (!body_pins_.empty()) {
    const std::vector<Offset> offsets = Merged(OffsetsTo(body_pins_, *follower));
    const std::vector<Vec3> track =
        OffsetTrack(offsets, BodyLimits(options_), timing_, follower->frame_count());
    ShiftAboveFeet(skeleton_, body_, track, options_.highest_heel_metres, timing_, follower);
  }
  for (std::size_t i = 0; i < limb_pins_.size(); ++i) {
    MoveToPins({skeleton_, LimbAt(body_, i), IsLeg(body_, i), LimbLimits(options_)}, limb_pins_[i],
               keep_ranges, timing_, follower);
  }
}

double MeanPinDistance(const Pins& pins, const motion::Poses& follower, int settled) {
  double sum = 0;
  int count = 0;
  for (const Pin& pin : pins) {
    if (pin.frame <= settled - 1 || pin.frame > follower.frame_count() - 1) continue;
    sum += double{Distance(JointAt(follower, pin), pin.position)};
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace duet::cleanup
