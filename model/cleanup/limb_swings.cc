#include "model/cleanup/limb_swings.h"

#include <cstddef>
#include <optional>
#include <vector>

#include "model/cleanup/directions.h"
#include "model/cleanup/girdle.h"
#include "model/cleanup/hinge.h"
#include "model/cleanup/turns.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;
using Track = std::vector<Vec3>;

// Metres. An elbow that is nearer to the line of its arm does not show in which direction it
// points.
constexpr float kClearBend = 0.03f;

// The direction in which the elbow points, of length 1, in every frame. A nearly straight arm keeps
// the direction of the frame before.
Track ElbowDirections(const body::Limb& arm, const Girdles& girdles, const motion::Poses& poses) {
  Track directions;
  directions.reserve(static_cast<std::size_t>(poses.frame_count()));
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3 bend = girdles[static_cast<std::size_t>(t)].Inwards(BendOf(arm, poses[t]));
    const float length = Norm(bend);
    const bool clear = length >= kClearBend || (directions.empty() && length > kNoDirection);
    const Vec3 before = directions.empty() ? Vec3{0, -1, 0} : directions.back();
    directions.push_back(clear ? bend / length : before);
  }
  return directions;
}

// Turns the elbow about the line from shoulder to hand, so that it does not change sides in a
// frame.
void SlowElbow(const body::Limb& arm, const Girdles& girdles, const LimbSwingOptions& options,
               const Timing& timing, motion::Poses* poses) {
  const Track before = ElbowDirections(arm, girdles, *poses);
  Track after = before;
  LimitTurns(timing.settled, MostInAFrame(options.fastest_elbow, timing), &after);
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    if (after[at] == before[at]) continue;
    ReachBent(arm, poses->at(t, arm.end), girdles[at].Outwards(after[at]), (*poses)[t]);
  }
}

// The directions of a bone, of length 1. A bone without length keeps the direction before.
Track BoneDirections(int from, int to, const Girdles& girdles, const motion::Poses& poses) {
  Track directions;
  directions.reserve(static_cast<std::size_t>(poses.frame_count()));
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3 bone =
        girdles[static_cast<std::size_t>(t)].Inwards(poses.at(t, to) - poses.at(t, from));
    const float length = Norm(bone);
    const Vec3 before = directions.empty() ? Vec3{0, -1, 0} : directions.back();
    directions.push_back(length > kNoDirection ? bone / length : before);
  }
  return directions;
}

struct BoneSpeeds {
  double upper = 0, lower = 0;  // degrees per second
};

// Where the end of a limb is from its upper joint, as the girdle sees it, no faster than `fastest`,
// metres per second. Shapes: returns [frames].
Track SlowEnds(const body::Limb& limb, const Girdles& girdles, double fastest, const Timing& timing,
               const motion::Poses& poses) {
  Track ends;
  ends.reserve(static_cast<std::size_t>(poses.frame_count()));
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3 way = poses.at(t, limb.end) - poses.at(t, limb.upper);
    ends.push_back(girdles[static_cast<std::size_t>(t)].Inwards(way));
  }
  LimitSteps(timing.settled, static_cast<float>(fastest / timing.frame_rate_hz), &ends);
  return ends;
}

// Limits the turns of both bones of a limb and of its hinge, as the girdle sees them. With
// `fastest_end`, metres per second, the end keeps its path unless that is faster: a knee that
// changes sides would throw its foot about, because half-way between two bent legs that end at one
// place is a leg that ends elsewhere.
void SlowLimb(const body::Limb& limb, const Girdles& girdles, const BoneSpeeds& fastest,
              const HingeLimits& hinge, std::optional<double> fastest_end, const Timing& timing,
              motion::Poses* poses) {
  const Track upper = BoneDirections(limb.upper, limb.middle, girdles, *poses);
  const Track lower = BoneDirections(limb.middle, limb.end, girdles, *poses);
  Track slow_upper = upper, slow_lower = lower;
  LimitTurns(timing.settled, MostInAFrame(fastest.upper, timing), &slow_upper);
  LimitTurns(timing.settled, MostInAFrame(fastest.lower, timing), &slow_lower);
  LimitHinge(slow_upper, hinge, timing, &slow_lower);
  Track ends;
  if (fastest_end) ends = SlowEnds(limb, girdles, *fastest_end, timing, *poses);
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    if (slow_upper[at] == upper[at] && slow_lower[at] == lower[at]) continue;
    const Vec3 from = poses->at(t, limb.upper), middle = poses->at(t, limb.middle);
    const Vec3 end = poses->at(t, limb.end);
    const Vec3 to_middle = girdles[at].Outwards(slow_upper[at]) * Distance(from, middle);
    const Vec3 to_end = girdles[at].Outwards(slow_lower[at]) * Distance(middle, end);
    poses->at(t, limb.middle) = from + to_middle;
    poses->at(t, limb.end) = from + to_middle + to_end;
    for (const int joint : limb.beyond) poses->at(t, joint) += poses->at(t, limb.end) - end;
    if (fastest_end) {
      ReachBent(limb, from + girdles[at].Outwards(ends[at]), BendOf(limb, (*poses)[t]),
                (*poses)[t]);
    }
  }
}

}  // namespace

void CalmLimbs(const body::Body& body, const LimbSwingOptions& options, const Timing& timing,
               motion::Poses* poses) {
  const Girdles shoulders = GirdlesOf(body, body.shoulders, *poses);
  for (const body::Limb& arm : body.arms) {
    SlowElbow(arm, shoulders, options, timing, poses);
    SlowLimb(arm, shoulders, {options.fastest_upper_arm, options.fastest_forearm}, options.hinge,
             std::nullopt, timing, poses);
  }
  if (body.legs.size() != 2) return;
  const motion::JointPair hip_joints{body.legs[0].upper, body.legs[1].upper};
  const Girdles hips = GirdlesOf(body, hip_joints, *poses);
  for (const body::Limb& leg : body.legs) {
    SlowLimb(leg, hips, {options.fastest_thigh, options.fastest_shin}, options.hinge,
             options.fastest_foot, timing, poses);
  }
}

}  // namespace duet::cleanup
