#include "model/cleanup/capsules.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/cleanup/low_pass.h"
#include "model/cleanup/spacing.h"
#include "model/motion/capsules.h"

namespace duet::cleanup {
namespace {

using motion::Bone;
using motion::Vec3;

constexpr double kBodySmoothSeconds = 0.2, kArmSmoothSeconds = 0.07;
// Maximum number of pushes per frame. Each resolves the deepest remaining overlap.
constexpr int kPushes = 5;
// Metres. A shorter offset has no direction.
constexpr float kNoDirection = 1e-4f;

// A bone's capsule in one frame.
struct Capsule {
  Vec3 from, to;
  double radius = 0;
};

// An overlap of two capsules beyond the limit, and the direction in which the follower leaves it.
struct Overlap {
  double depth = 0;
  Vec3 out;  // of length 1
};

// Whether the bounding spheres of two capsules overlap.
bool MayTouch(const Capsule& a, const Capsule& b) {
  const Vec3 apart = (a.from + a.to - b.from - b.to) * 0.5f;
  const float reach = (Distance(a.from, a.to) + Distance(b.from, b.to)) * 0.5f +
                      static_cast<float>(a.radius + b.radius);
  return Dot(apart, apart) < reach * reach;
}

Overlap FindOverlap(const Capsule& leader, const Capsule& follower, double allowed) {
  if (!MayTouch(leader, follower)) return {};
  const motion::ClosestPoints closest =
      motion::FindClosestPoints(leader.from, leader.to, follower.from, follower.to);
  const double depth = leader.radius + follower.radius - allowed - closest.distance;
  if (depth <= 0 || closest.distance < kNoDirection) return {std::max(0.0, depth), {}};
  return {depth, (closest.on_b - closest.on_a) / static_cast<float>(closest.distance)};
}

std::vector<Capsule> CapsulesOf(const std::vector<Bone>& bones, const std::vector<double>& radii,
                                absl::Span<const Vec3> pose) {
  std::vector<Capsule> capsules;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    capsules.push_back({pose[static_cast<std::size_t>(bones[b].parent)],
                        pose[static_cast<std::size_t>(bones[b].child)], radii[b]});
  }
  return capsules;
}

bool IsInside(const body::Limb& limb, const Bone& bone) {
  return bone.parent == limb.upper || bone.parent == limb.middle || bone.parent == limb.end ||
         std::find(limb.beyond.begin(), limb.beyond.end(), bone.parent) != limb.beyond.end();
}

// Indices of all bones except those of arms.
std::vector<std::size_t> AllButArms(const motion::Skeleton& skeleton, const body::Body& body) {
  std::vector<std::size_t> bones;
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
    const auto inside = [&](const body::Limb& limb) { return IsInside(limb, skeleton.bones[b]); };
    if (std::none_of(body.arms.begin(), body.arms.end(), inside)) bones.push_back(b);
  }
  return bones;
}

// The distance along `way` after which none of these bones of the two people overlap.
float RoomToMake(const std::vector<Capsule>& leader, std::vector<Capsule> follower,
                 const std::vector<std::size_t>& bones, Vec3 way, double allowed) {
  double room = 0;
  for (int push = 0; push < kPushes; ++push) {
    double deepest = 0;
    for (const std::size_t a : bones) {
      for (const std::size_t b : bones) {
        deepest = std::max(deepest, FindOverlap(leader[a], follower[b], allowed).depth);
      }
    }
    if (deepest == 0) break;
    room += deepest;
    for (const std::size_t b : bones) {
      follower[b].from += way * static_cast<float>(deepest);
      follower[b].to += way * static_cast<float>(deepest);
    }
  }
  return static_cast<float>(room);
}

// The axis of the trunk, from the middle of the hips to the chest, as a capsule.
Capsule TrunkOf(const motion::Skeleton& skeleton, const body::Body& body,
                absl::Span<const Vec3> pose, double radius) {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  return {Lerp(at(skeleton.hips->left), at(skeleton.hips->right), 0.5f), at(*body.chest), radius};
}

// Trunks and heads as capsules whose distance is the smallest permitted one.
std::vector<Capsule> Cores(const motion::Skeleton& skeleton, const body::Body& body,
                           const CapsuleOptions& options, absl::Span<const Vec3> pose) {
  std::vector<Capsule> cores = {TrunkOf(skeleton, body, pose, options.trunks_metres / 2)};
  if (body.neck) {
    const Vec3 head = pose[static_cast<std::size_t>(body.neck->head)];
    cores.push_back({head, head, options.heads_metres / 2});
  }
  return cores;
}

// The horizontal direction from leader to follower, of length 1.
Vec3 WayApart(Vec3 leader, Vec3 follower) {
  const Vec3 way = {follower.x - leader.x, 0, follower.z - leader.z};
  const float length = Norm(way);
  return length > kNoDirection ? way / length : Vec3{0, 0, 1};
}

// The deepest overlap of the arm's two bones with the leader, the outer bone first.
Overlap DeepestOverlap(const std::vector<Capsule>& leader, const Capsule& outer,
                       const Capsule& inner, double allowed) {
  Overlap deepest;
  for (const Capsule& capsule : leader) {
    for (const Capsule& bone : {outer, inner}) {
      const Overlap overlap = FindOverlap(capsule, bone, allowed);
      if (overlap.depth > deepest.depth && overlap.out != Vec3{}) deepest = overlap;
    }
  }
  return deepest;
}

// The offset by which a hand must move to resolve the arm's overlap. Uses `pose` as scratch space.
Vec3 WayOut(const body::Limb& arm, double radius, const std::vector<Capsule>& leader,
            double allowed, Vec3 backwards, std::vector<Vec3> pose) {
  const Vec3 from = pose[static_cast<std::size_t>(arm.end)];
  for (int push = 0; push < kPushes; ++push) {
    const Vec3 shoulder = pose[static_cast<std::size_t>(arm.upper)];
    const Vec3 elbow = pose[static_cast<std::size_t>(arm.middle)];
    const Vec3 hand = pose[static_cast<std::size_t>(arm.end)];
    const Overlap overlap =
        DeepestOverlap(leader, {elbow, hand, radius}, {shoulder, elbow, radius}, allowed);
    if (overlap.depth <= 0) break;
    Reach(arm, hand + overlap.out * static_cast<float>(overlap.depth), backwards,
          absl::MakeSpan(pose));
  }
  return pose[static_cast<std::size_t>(arm.end)] - from;
}

double RadiusOf(const body::Limb& arm, const motion::Skeleton& skeleton,
                const std::vector<double>& radii) {
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
    if (skeleton.bones[b] == Bone{arm.middle, arm.end}) return radii[b];
  }
  return 0;
}

}  // namespace

void PartBodies(const motion::Skeleton& skeleton, const body::Body& body,
                const std::vector<double>& radii, const motion::Poses& leader, const Touch& touch,
                const CapsuleOptions& options, const Timing& timing, motion::Poses* follower) {
  if (!body.chest) return;
  const std::vector<std::size_t> bones = AllButArms(skeleton, body);
  const std::vector<std::size_t> trunk_only = {0}, trunk_and_head = {0, 1};
  const std::vector<std::size_t>& cores = body.neck ? trunk_and_head : trunk_only;
  std::vector<float> room;
  std::vector<Vec3> ways;
  for (int t = 0; t < follower->frame_count(); ++t) {
    ways.push_back(WayApart(leader.at(t, skeleton.root), follower->at(t, skeleton.root)));
    const float for_bodies = RoomToMake(CapsulesOf(skeleton.bones, radii, leader[t]),
                                        CapsulesOf(skeleton.bones, radii, (*follower)[t]), bones,
                                        ways.back(), options.allowed_metres);
    const float for_cores =
        RoomToMake(Cores(skeleton, body, options, leader[t]),
                   Cores(skeleton, body, options, (*follower)[t]), cores, ways.back(), 0);
    room.push_back(std::max(for_bodies * (1 - touch[static_cast<std::size_t>(t)]), for_cores));
  }
  const double smooth = timing.Frames(kBodySmoothSeconds);
  room = LowPass(MostAround(room, static_cast<int>(std::lround(smooth))), smooth);
  for (std::size_t t = 0; t < ways.size(); ++t) ways[t] = ways[t] * room[t];
  ShiftBody(ways, options.fastest_metres_per_second, timing, follower);
}

void PartArms(const motion::Skeleton& skeleton, const body::Body& body,
              const std::vector<double>& radii, const motion::Poses& leader, const Touch& touch,
              const CapsuleOptions& options, const Timing& timing, motion::Poses* follower) {
  for (const body::Limb& arm : body.arms) {
    const double radius = RadiusOf(arm, skeleton, radii);
    std::vector<Vec3> ways, backwards;
    for (int t = 0; t < follower->frame_count(); ++t) {
      const absl::Span<const Vec3> pose = (*follower)[t];
      backwards.push_back(-body::Facing(*skeleton.hips, pose));
      const Vec3 way = WayOut(arm, radius, CapsulesOf(skeleton.bones, radii, leader[t]),
                              options.allowed_metres, backwards.back(), {pose.begin(), pose.end()});
      ways.push_back(way * (1 - touch[static_cast<std::size_t>(t)]));
    }
    ways = LowPass(ways, timing.Frames(kArmSmoothSeconds));
    for (int t = timing.settled; t < follower->frame_count(); ++t) {
      const Vec3 way = ways[static_cast<std::size_t>(t)] * EaseIn(timing, t);
      Reach(arm, follower->at(t, arm.end) + way, backwards[static_cast<std::size_t>(t)],
            (*follower)[t]);
    }
  }
}

}  // namespace duet::cleanup
