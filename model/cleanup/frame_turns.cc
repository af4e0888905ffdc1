#include "model/cleanup/frame_turns.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "model/base/angle.h"
#include "model/cleanup/directions.h"
#include "model/cleanup/girdle.h"
#include "model/cleanup/turns.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;
using Pose = absl::Span<const Vec3>;

// The sine of the smallest bend that shows its plane: 6 degrees.
constexpr float kClearBend = 0.1f;

Vec3 At(Pose pose, int joint) { return pose[static_cast<std::size_t>(joint)]; }

// How far bones may turn in a frame, radians.
struct Most {
  float upper = 0, lower = 0, plane = 0, plane_of_girdle = 0;
};

// The directions of a limb's bones, of length 1.
struct Bones {
  Vec3 upper, lower;
};

std::optional<Bones> BonesOf(const body::Limb& limb, Pose pose) {
  const Vec3 upper = At(pose, limb.middle) - At(pose, limb.upper);
  const Vec3 lower = At(pose, limb.end) - At(pose, limb.middle);
  const float upper_length = Norm(upper), lower_length = Norm(lower);
  if (upper_length < kNoDirection || lower_length < kNoDirection) return std::nullopt;
  return Bones{upper / upper_length, lower / lower_length};
}

// `to`, with the plane in which it bends from the upper bone turned by at most `most` from that of
// `from`.
Vec3 LimitPlane(Vec3 upper, Vec3 from, Vec3 to, float most) {
  const Vec3 before = Cross(upper, from), now = Cross(upper, to);
  if (Norm(before) < kClearBend || Norm(now) < kClearBend) return to;
  const float turn = SignedAngle(before, now, upper);
  if (std::abs(turn) <= most) return to;
  return RotateAbout(to, upper, std::copysign(most, turn) - turn);
}

// The bones of a frame, turned no farther from those of the frame before than they may. Bones turn
// against the girdle, which carries the limb, and planes also in the world, where they are seen.
Bones Limited(const Bones& from, const Girdle& girdle_before, const Bones& to, const Girdle& girdle,
              const Most& most) {
  Bones bones = to;
  const Vec3 carried_upper = girdle.Outwards(girdle_before.Inwards(from.upper));
  bones.upper = TurnTowards(carried_upper, to.upper, most.upper);
  // A limb that is slowed down keeps its bend.
  if (bones.upper != to.upper) bones.lower = Carried(to.upper, bones.upper, to.lower);
  const Vec3 carried_lower =
      Carried(carried_upper, bones.upper, girdle.Outwards(girdle_before.Inwards(from.lower)));
  bones.lower = LimitPlane(bones.upper, carried_lower, bones.lower, most.plane_of_girdle);
  bones.lower = LimitPlane(bones.upper, Carried(from.upper, bones.upper, from.lower), bones.lower,
                           most.plane);
  bones.lower = TurnTowards(carried_lower, bones.lower, most.lower);
  return bones;
}

void SlowLimb(const body::Limb& limb, const Girdle& girdle_before, const Girdle& girdle,
              const Most& most, bool stands, Pose before, absl::Span<Vec3> pose) {
  const std::optional<Bones> from = BonesOf(limb, before), to = BonesOf(limb, pose);
  if (!from || !to) return;
  const Bones bones = Limited(*from, girdle_before, *to, girdle, most);
  if (bones.upper == to->upper && bones.lower == to->lower) return;
  Vec3& middle = pose[static_cast<std::size_t>(limb.middle)];
  Vec3& end = pose[static_cast<std::size_t>(limb.end)];
  const Vec3 top = At(pose, limb.upper), end_before = end;
  const float upper_length = Distance(top, middle), lower_length = Distance(middle, end);
  middle = top + bones.upper * upper_length;
  end = middle + bones.lower * lower_length;
  for (const int joint : limb.beyond) {
    pose[static_cast<std::size_t>(joint)] += end - end_before;
  }
  if (stands) ReachBent(limb, end_before, BendOf(limb, pose), pose);
}

bool IsAttached(const motion::Skeleton& skeleton, int parent, int child) {
  return std::any_of(skeleton.bones.begin(), skeleton.bones.end(), [&](const motion::Bone& bone) {
    return bone.parent == parent && bone.child == child;
  });
}

void MoveLimb(const body::Limb& limb, Vec3 way, absl::Span<Vec3> pose) {
  for (const int joint : {limb.upper, limb.middle, limb.end}) {
    pose[static_cast<std::size_t>(joint)] += way;
  }
  for (const int joint : limb.beyond) pose[static_cast<std::size_t>(joint)] += way;
}

// Turns the shoulders about the chest no farther than they may. Arms move with them.
void SlowShoulders(const motion::Skeleton& skeleton, const body::Body& body, float most,
                   Pose before, absl::Span<Vec3> pose) {
  if (!body.chest) return;
  const Vec3 chest = At(pose, *body.chest), chest_before = At(before, *body.chest);
  for (const body::Limb& arm : body.arms) {
    if (!IsAttached(skeleton, *body.chest, arm.upper)) continue;
    const Vec3 from = At(before, arm.upper) - chest_before, to = At(pose, arm.upper) - chest;
    const float from_length = Norm(from), length = Norm(to);
    if (from_length < kNoDirection || length < kNoDirection) continue;
    const Vec3 turned = TurnTowards(from / from_length, to / length, most);
    if (turned != to / length) MoveLimb(arm, chest + turned * length - At(pose, arm.upper), pose);
  }
}

// Turns the hips about the trunk no farther than they may. Legs follow, and feet stay.
void SlowHips(const motion::Skeleton& skeleton, const body::Body& body, float most, Pose before,
              absl::Span<Vec3> pose) {
  if (!skeleton.hips || !body.chest || body.legs.size() != 2) return;
  const auto [left, right] = *skeleton.hips;
  const Vec3 middle = Lerp(At(pose, left), At(pose, right), 0.5f);
  const Vec3 trunk = At(pose, *body.chest) - middle;
  if (Norm(trunk) < kNoDirection) return;
  const Vec3 up = trunk / Norm(trunk);
  const auto across = [&](Pose of) {
    const Vec3 line = At(of, left) - At(of, right);
    const Vec3 level = line - up * Dot(line, up);
    return Norm(level) > kNoDirection ? level / Norm(level) : Vec3{};
  };
  const float turn = SignedAngle(across(before), across(pose), up);
  if (std::abs(turn) <= most) return;
  const float back = std::copysign(most, turn) - turn;
  for (const body::Limb& leg : body.legs) {
    const Vec3 hip = At(pose, leg.upper), foot = At(pose, leg.end);
    const Vec3 bend = RotateAbout(BendOf(leg, pose), up, back);
    MoveLimb(leg, middle + RotateAbout(hip - middle, up, back) - hip, pose);
    ReachBent(leg, foot, bend, pose);
  }
}

}  // namespace

void SlowFrame(const motion::Skeleton& skeleton, const body::Body& body,
               const FrameTurnOptions& options, double frame_rate_hz, Pose before,
               absl::Span<Vec3> pose) {
  const auto in_a_frame = [&](double degrees_per_second) {
    return static_cast<float>(base::kRadiansPerDegree * degrees_per_second / frame_rate_hz);
  };
  const Most most{
      in_a_frame(options.fastest_bone), in_a_frame(options.fastest_bone),
      std::min(in_a_frame(options.fastest_plane),
               static_cast<float>(base::kRadiansPerDegree * options.most_plane_degrees)),
      in_a_frame(options.fastest_plane_of_girdle)};
  SlowShoulders(skeleton, body, in_a_frame(options.fastest_shoulder), before, pose);
  SlowHips(skeleton, body, in_a_frame(options.fastest_hips), before, pose);
  const Girdle shoulders_before = GirdleOf(body, body.shoulders, before);
  const Girdle shoulders = GirdleOf(body, body.shoulders, pose);
  Most most_of_arms = most;
  most_of_arms.upper = in_a_frame(options.fastest_upper_arm);
  for (const body::Limb& arm : body.arms) {
    SlowLimb(arm, shoulders_before, shoulders, most_of_arms, /*stands=*/false, before, pose);
  }
  if (body.legs.size() != 2) return;
  const motion::JointPair hip_joints{body.legs[0].upper, body.legs[1].upper};
  const Girdle hips_before = GirdleOf(body, hip_joints, before);
  const Girdle hips = GirdleOf(body, hip_joints, pose);
  for (const body::Limb& leg : body.legs) {
    const double way = double{Distance(At(before, leg.end), At(pose, leg.end))};
    const bool stands = way * frame_rate_hz < options.stands_metres_per_second;
    SlowLimb(leg, hips_before, hips, most, stands, before, pose);
  }
}

}  // namespace duet::cleanup
