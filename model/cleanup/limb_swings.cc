#include "model/cleanup/limb_swings.h"

#include <cstddef>
#include <vector>

#include "model/cleanup/turns.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;
using Track = std::vector<Vec3>;

// Metres. An elbow that is nearer to the line of its arm does not show in which direction it
// points.
constexpr float kClearBend = 0.03f;
// Metres. A shorter vector has no direction.
constexpr float kNoDirection = 1e-4f;

// The direction in which the elbow points, of length 1, in every frame. A nearly straight arm keeps
// the direction of the frame before.
Track ElbowDirections(const body::Limb& arm, const motion::Poses& poses) {
  Track directions;
  directions.reserve(static_cast<std::size_t>(poses.frame_count()));
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3 bend = BendOf(arm, poses[t]);
    const float length = Norm(bend);
    const bool clear = length >= kClearBend || (directions.empty() && length > kNoDirection);
    const Vec3 before = directions.empty() ? Vec3{0, -1, 0} : directions.back();
    directions.push_back(clear ? bend / length : before);
  }
  return directions;
}

// Turns the elbow about the line from shoulder to hand, so that it does not change sides in a
// frame.
void SlowElbow(const body::Limb& arm, const LimbSwingOptions& options, const Timing& timing,
               motion::Poses* poses) {
  const Track before = ElbowDirections(arm, *poses);
  Track after = before;
  LimitTurns(timing.settled, MostInAFrame(options.fastest_elbow, timing), &after);
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    if (after[at] == before[at]) continue;
    ReachBent(arm, poses->at(t, arm.end), after[at], (*poses)[t]);
  }
}

// The directions of a bone, of length 1. A bone without length keeps the direction before.
Track BoneDirections(int from, int to, const motion::Poses& poses) {
  Track directions;
  directions.reserve(static_cast<std::size_t>(poses.frame_count()));
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3 bone = poses.at(t, to) - poses.at(t, from);
    const float length = Norm(bone);
    const Vec3 before = directions.empty() ? Vec3{0, -1, 0} : directions.back();
    directions.push_back(length > kNoDirection ? bone / length : before);
  }
  return directions;
}

// Limits the turns of both bones of a limb, degrees per second.
void SlowBones(const body::Limb& limb, double fastest_inner, double fastest_outer,
               const Timing& timing, motion::Poses* poses) {
  const Track inner = BoneDirections(limb.upper, limb.middle, *poses);
  const Track outer = BoneDirections(limb.middle, limb.end, *poses);
  Track slow_inner = inner, slow_outer = outer;
  LimitTurns(timing.settled, MostInAFrame(fastest_inner, timing), &slow_inner);
  LimitTurns(timing.settled, MostInAFrame(fastest_outer, timing), &slow_outer);
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    if (slow_inner[at] == inner[at] && slow_outer[at] == outer[at]) continue;
    const Vec3 upper = poses->at(t, limb.upper), middle = poses->at(t, limb.middle);
    const Vec3 end = poses->at(t, limb.end);
    poses->at(t, limb.middle) = upper + slow_inner[at] * Distance(upper, middle);
    poses->at(t, limb.end) = poses->at(t, limb.middle) + slow_outer[at] * Distance(middle, end);
    for (const int joint : limb.beyond) poses->at(t, joint) += poses->at(t, limb.end) - end;
  }
}

}  // namespace

void CalmLimbs(const body::Body& body, const LimbSwingOptions& options, const Timing& timing,
               motion::Poses* poses) {
  for (const body::Limb& arm : body.arms) {
    SlowElbow(arm, options, timing, poses);
    SlowBones(arm, options.fastest_upper_arm, options.fastest_forearm, timing, poses);
  }
  for (const body::Limb& leg : body.legs) {
    SlowBones(leg, options.fastest_thigh, options.fastest_shin, timing, poses);
  }
}

}  // namespace duet::cleanup
