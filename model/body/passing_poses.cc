#include "model/body/passing_poses.h"

#include <algorithm>
#include <cstddef>

#include "model/body/contact.h"

namespace duet::body {
namespace {

using motion::Vec3;
using Pose = absl::Span<const Vec3>;

constexpr float kAstrideLegs = 0.75f;
constexpr float kHangingArms = 0.3f, kHeldMetres = 0.35f;
constexpr double kReachingArms = 0.4;

Vec3 At(Pose pose, int joint) { return pose[static_cast<std::size_t>(joint)]; }

void Count(bool lasts, int* frames, int* longest) {
  *frames = lasts ? *frames + 1 : 0;
  *longest = std::max(*longest, *frames);
}

}  // namespace

Vec3 Stride(const Body& body, Pose pose) {
  const Vec3 apart = At(pose, body.legs[1].end) - At(pose, body.legs[0].end);
  return {apart.x, 0, apart.z};
}

bool IsAstride(const Body& body, Pose pose) {
  if (body.legs.size() != 2) return false;
  return Norm(Stride(body, pose)) > kAstrideLegs * LengthOf(body.legs[0], pose);
}

bool IsHeldOut(const Body& body, const Limb& arm, int root, Pose partner, Pose pose) {
  const Vec3 hand = At(pose, arm.end);
  if (At(pose, arm.upper).y - hand.y > kHangingArms * LengthOf(arm, pose)) return false;
  const bool held = std::any_of(body.arms.begin(), body.arms.end(), [&](const Limb& other) {
    return Distance(At(partner, other.end), hand) < kHeldMetres;
  });
  return !held && ReachTowards(arm, root, pose, At(partner, root)) < kReachingArms;
}

LongestPoses::LongestPoses(const motion::Skeleton& skeleton, const Body& body)
    : skeleton_(skeleton), body_(body), held_out_(body.arms.size()) {}

void LongestPoses::Add(Pose partner, Pose pose) {
  Count(IsAstride(body_, pose), &astride_, &longest_astride_);
  for (std::size_t a = 0; a < held_out_.size(); ++a) {
    Count(IsHeldOut(body_, body_.arms[a], skeleton_.root, partner, pose), &held_out_[a],
          &longest_held_out_);
  }
}

PoseSeconds LongestPoses::Get(double frame_rate_hz) const {
  return {longest_astride_ / frame_rate_hz, longest_held_out_ / frame_rate_hz};
}

}  // namespace duet::body
