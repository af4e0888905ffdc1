#include "model/cleanup/capsules.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/cleanup/directions.h"
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

// Two bounding spheres that are nearer than this count as touching, whatever rounding says; metres.
constexpr float kRounding = 1e-5f;

// A bone's capsule in one frame, with its bounding sphere.
struct Capsule {
  Capsule(Vec3 a, Vec3 b, double metres)
      : from(a),
        to(b),
        radius(metres),
        middle((a + b) * 0.5f),
        reach(Distance(a, b) * 0.5f + static_cast<float>(metres)) {}

  void Move(Vec3 way) {
    from += way;
    to += way;
    middle += way;
  }

  Vec3 from, to;
  double radius;
  Vec3 middle;
  float reach;
};
using Capsules = std::vector<Capsule>;

// An overlap of two capsules beyond the limit, and the direction in which the follower leaves it.
struct Overlap {
  double depth = 0;
  Vec3 out;  // of length 1
};

// Whether two capsules may overlap by more than `depth`: their bounding spheres do.
bool MayOverlap(const Capsule& a, const Capsule& b, double depth) {
  const float reach = a.reach + b.reach - static_cast<float>(depth) + kRounding;
  const Vec3 apart = a.middle - b.middle;
  return reach > 0 && Dot(apart, apart) < reach * reach;
}

Overlap FindOverlap(const Capsule& leader, const Capsule& follower, double allowed) {
  const motion::ClosestPoints closest =
      motion::FindClosestPoints(leader.from, leader.to, follower.from, follower.to);
  const double depth = leader.radius + follower.radius - allowed - closest.distance;
  if (depth <= 0 || closest.distance < kNoDirection) return {std::max(0.0, depth), {}};
  return {depth, (closest.on_b - closest.on_a) / static_cast<float>(closest.distance)};
}

// A bone and the radius of its capsule.
struct Part {
  Bone bone;
  double radius;
};
using Parts = std::vector<Part>;

// Appends the capsules of a pose.
void AddCapsules(const Parts& parts, absl::Span<const Vec3> pose, Capsules* capsules) {
  for (const Part& part : parts) {
    capsules->emplace_back(pose[static_cast<std::size_t>(part.bone.parent)],
                           pose[static_cast<std::size_t>(part.bone.child)], part.radius);
  }
}

Parts AllParts(const motion::Skeleton& skeleton, const std::vector<double>& radii) {
  Parts parts;
  for (std::size_t b = 0; b < radii.size(); ++b) parts.push_back({skeleton.bones[b], radii[b]});
  return parts;
}

bool IsInside(const body::Limb& limb, const Bone& bone) {
  return bone.parent == limb.upper || bone.parent == limb.middle || bone.parent == limb.end ||
         std::find(limb.beyond.begin(), limb.beyond.end(), bone.parent) != limb.beyond.end();
}

Parts AllButArms(const body::Body& body, Parts parts) {
  const auto of_arm = [&](const Part& part) {
    return std::any_of(body.arms.begin(), body.arms.end(),
                       [&](const body::Limb& arm) { return IsInside(arm, part.bone); });
  };
  parts.erase(std::remove_if(parts.begin(), parts.end(), of_arm), parts.end());
  return parts;
}

// The distance along `way` after which no capsules of the two people overlap. Moves the follower's.
float RoomToMake(const Capsules& leader, Vec3 way, double allowed, Capsules* follower) {
  double room = 0;
  for (int push = 0; push < kPushes; ++push) {
    double deepest = 0;
    for (const Capsule& a : leader) {
      for (const Capsule& b : *follower) {
        if (!MayOverlap(a, b, allowed + deepest)) continue;
        deepest = std::max(deepest, FindOverlap(a, b, allowed).depth);
      }
    }
    if (deepest == 0) break;
    room += deepest;
    for (Capsule& capsule : *follower) capsule.Move(way * static_cast<float>(deepest));
  }
  return static_cast<float>(room);
}

// The axis of the trunk, from the middle of the hips to the chest, as a capsule.
Capsule TrunkOf(const motion::Skeleton& skeleton, const body::Body& body,
                absl::Span<const Vec3> pose, double radius) {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  return {Lerp(at(skeleton.hips->left), at(skeleton.hips->right), 0.5f), at(*body.chest), radius};
}

// Appends trunk and head as capsules whose distance is the smallest permitted one.
void AddCores(const motion::Skeleton& skeleton, const body::Body& body,
              const CapsuleOptions& options, absl::Span<const Vec3> pose, Capsules* cores) {
  cores->push_back(TrunkOf(skeleton, body, pose, options.trunks_metres / 2));
  if (!body.neck) return;
  const Vec3 head = pose[static_cast<std::size_t>(body.neck->head)];
  cores->emplace_back(head, head, options.heads_metres / 2);
}

// The horizontal direction from leader to follower, of length 1.
Vec3 WayApart(Vec3 leader, Vec3 follower) {
  const Vec3 way = {follower.x - leader.x, 0, follower.z - leader.z};
  const float length = Norm(way);
  return length > kNoDirection ? way / length : Vec3{0, 0, 1};
}

// The deepest overlap of the arm's two bones with the leader, the outer bone first.
Overlap DeepestOverlap(absl::Span<const Capsule> leader, const Capsule& outer, const Capsule& inner,
                       double allowed) {
  Overlap deepest;
  for (const Capsule& capsule : leader) {
    for (const Capsule* bone : {&outer, &inner}) {
      if (!MayOverlap(capsule, *bone, allowed + deepest.depth)) continue;
      const Overlap overlap = FindOverlap(capsule, *bone, allowed);
      if (overlap.depth > deepest.depth && overlap.out != Vec3{}) deepest = overlap;
    }
  }
  return deepest;
}

// The offset by which a hand must move to resolve the arm's overlap. Moves the arm.
Vec3 WayOut(const body::Limb& arm, double radius, absl::Span<const Capsule> leader, double allowed,
            Vec3 backwards, absl::Span<Vec3> pose) {
  const Vec3 from = pose[static_cast<std::size_t>(arm.end)];
  for (int push = 0; push < kPushes; ++push) {
    const Vec3 shoulder = pose[static_cast<std::size_t>(arm.upper)];
    const Vec3 elbow = pose[static_cast<std::size_t>(arm.middle)];
    const Vec3 hand = pose[static_cast<std::size_t>(arm.end)];
    const Overlap overlap =
        DeepestOverlap(leader, {elbow, hand, radius}, {shoulder, elbow, radius}, allowed);
    if (overlap.depth <= 0) break;
    Reach(arm, hand + overlap.out * static_cast<float>(overlap.depth), backwards, pose);
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
  const Parts parts = AllButArms(body, AllParts(skeleton, radii));
  const std::size_t frames = static_cast<std::size_t>(follower->frame_count());
  std::vector<float> room;
  std::vector<Vec3> ways;
  room.reserve(frames);
  ways.reserve(frames);
  Capsules of_leader, of_follower;  // reused, so that a frame allocates nothing
  const auto start = [&] {
    of_leader.clear();
    of_follower.clear();
  };
  for (int t = 0; t < follower->frame_count(); ++t) {
    const absl::Span<const Vec3> led = leader[t], followed = (*follower)[t];
    ways.push_back(WayApart(leader.at(t, skeleton.root), follower->at(t, skeleton.root)));
    start();
    AddCapsules(parts, led, &of_leader);
    AddCapsules(parts, followed, &of_follower);
    const float for_bodies =
        RoomToMake(of_leader, ways.back(), options.allowed_metres, &of_follower);
    start();
    AddCores(skeleton, body, options, led, &of_leader);
    AddCores(skeleton, body, options, followed, &of_follower);
    const float for_cores = RoomToMake(of_leader, ways.back(), 0, &of_follower);
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
  const Parts parts = AllParts(skeleton, radii);
  Capsules of_leader;  // [frames, parts]
  of_leader.reserve(static_cast<std::size_t>(leader.frame_count()) * parts.size());
  for (int t = 0; t < leader.frame_count(); ++t) AddCapsules(parts, leader[t], &of_leader);
  std::vector<Vec3> tried;  // a pose; reused, so that a frame allocates nothing
  for (const body::Limb& arm : body.arms) {
    const double radius = RadiusOf(arm, skeleton, radii);
    std::vector<Vec3> ways, backwards;
    for (int t = 0; t < follower->frame_count(); ++t) {
      const absl::Span<const Vec3> pose = (*follower)[t];
      tried.assign(pose.begin(), pose.end());
      backwards.push_back(-body::Facing(*skeleton.hips, pose));
      const auto capsules = absl::MakeConstSpan(of_leader).subspan(
          static_cast<std::size_t>(t) * parts.size(), parts.size());
      const Vec3 way = WayOut(arm, radius, capsules, options.allowed_metres, backwards.back(),
                              absl::MakeSpan(tried));
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
