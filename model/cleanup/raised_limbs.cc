#include "model/cleanup/raised_limbs.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "model/body/passing_poses.h"
#include "model/cleanup/lasting.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

// How far a hand that came down is from its shoulder, in lengths of the arm.
constexpr float kHanging = 0.93f;

// Moves the end of a limb by a share of its way to a place that depends on the pose. `forwards`: 1
// for a knee, -1 for an elbow, which bends backwards.
void Lower(const body::Limb& limb, const std::vector<float>& lowered,
           const std::function<Vec3(absl::Span<const Vec3>)>& place, float forwards,
           const motion::JointPair& hips, const Timing& timing, motion::Poses* poses) {
  for (int t = timing.settled; t < poses->frame_count() && !lowered.empty(); ++t) {
    const float share = lowered[static_cast<std::size_t>(t)];
    if (share == 0) continue;
    const absl::Span<Vec3> pose = (*poses)[t];
    const Vec3 facing = body::Facing(hips, pose);
    Reach(limb, Lerp(poses->at(t, limb.end), place(pose), share), facing * forwards, pose);
  }
}

void LowerFoot(const motion::Skeleton& skeleton, const body::Limb& leg, float floor,
               const RaisedLimbOptions& options, const Timing& timing, motion::Poses* poses) {
  const float high = floor + static_cast<float>(options.foot_metres);
  const auto raised = [&](int t) { return poses->at(t, leg.end).y > high; };
  Lasting lasting{options.longest_foot_seconds, options.ease_seconds};
  if (timing.settled == 0) {
    lasting.before_seconds = options.longest_foot_seconds + options.ease_seconds;
  }
  const std::vector<float> lowered = SharesOfLasting(raised, lasting, timing, poses->frame_count());
  const auto below_hip = [&](absl::Span<const Vec3> pose) {
    const Vec3 hip = pose[static_cast<std::size_t>(leg.upper)];
    return Vec3{hip.x, floor, hip.z};
  };
  Lower(leg, lowered, below_hip, /*forwards=*/1, *skeleton.hips, timing, poses);
}

// Moves the hand to its place beside the body where `up` lasts longer than a time.
void LowerHand(const motion::Skeleton& skeleton, const body::Limb& arm,
               const std::function<bool(int)>& up, double longest_seconds,
               const RaisedLimbOptions& options, const Timing& timing, motion::Poses* poses) {
  const std::vector<float> lowered =
      SharesOfLasting(up, {longest_seconds, options.ease_seconds}, timing, poses->frame_count());
  const auto beside_body = [&](absl::Span<const Vec3> pose) {
    const Vec3 shoulder = pose[static_cast<std::size_t>(arm.upper)];
    return shoulder - Vec3{0, kHanging * LengthOf(arm, pose), 0};
  };
  Lower(arm, lowered, beside_body, /*forwards=*/-1, *skeleton.hips, timing, poses);
}

void LowerHands(const motion::Skeleton& skeleton, const body::Body& body, const body::Limb& arm,
                const motion::Poses& leader, const RaisedLimbOptions& options, const Timing& timing,
                motion::Poses* poses) {
  const float high = static_cast<float>(options.hand_metres);
  const auto held = [&](int t) {
    return std::any_of(body.arms.begin(), body.arms.end(), [&](const body::Limb& other) {
      return Distance(leader.at(t, other.end), poses->at(t, arm.end)) <
             static_cast<float>(options.held_metres);
    });
  };
  const auto raised = [&](int t) {
    return poses->at(t, arm.end).y > poses->at(t, arm.upper).y + high && !held(t);
  };
  LowerHand(skeleton, arm, raised, options.longest_hand_seconds, options, timing, poses);
  if (options.longest_held_out_seconds == 0) return;
  const auto held_out = [&](int t) {
    return IsHeldOut(body, arm, skeleton.root, leader[t], (*poses)[t]);
  };
  LowerHand(skeleton, arm, held_out, options.longest_held_out_seconds, options, timing, poses);
}

}  // namespace

void LowerLimbs(const motion::Skeleton& skeleton, const body::Body& body,
                std::optional<float> floor, const motion::Poses& leader,
                const RaisedLimbOptions& options, const Timing& timing, motion::Poses* follower) {
  if (!skeleton.hips) return;
  for (const body::Limb& leg : body.legs) {
    if (floor) LowerFoot(skeleton, leg, *floor, options, timing, follower);
  }
  if (!body.shoulders) return;
  for (const body::Limb& arm : body.arms) {
    LowerHands(skeleton, body, arm, leader, options, timing, follower);
  }
}

}  // namespace duet::cleanup
