#include "model/body/contact.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "model/motion/capsules.h"

namespace duet::body {

double ReachTowards(const Limb& arm, int root, absl::Span<const motion::Vec3> pose,
                    motion::Vec3 partner_root) {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  const float length = LengthOf(arm, pose);
  const motion::Vec3 way = {partner_root.x - at(root).x, 0, partner_root.z - at(root).z};
  if (length == 0 || Norm(way) == 0) return 0;
  return double{Dot(at(arm.end) - at(root), way) / (Norm(way) * length)};
}

std::optional<double> OfferedHandDistance(const Body& body, int root,
                                          absl::Span<const motion::Vec3> leader,
                                          absl::Span<const motion::Vec3> follower) {
  std::optional<double> nearest;
  for (const Limb& offered : body.arms) {
    const motion::Vec3 partner = follower[static_cast<std::size_t>(root)];
    if (ReachTowards(offered, root, leader, partner) < kOffersReach) continue;
    for (const Limb& arm : body.arms) {
      const double distance = double{Distance(leader[static_cast<std::size_t>(offered.end)],
                                              follower[static_cast<std::size_t>(arm.end)])};
      nearest = std::min(nearest.value_or(distance), distance);
    }
  }
  return nearest;
}

namespace {

// Above rounding errors, metres.
constexpr float kSlack = 1e-4f;

// A bone in one frame, and the sphere around it.
struct PlacedBone {
  motion::Vec3 from, to, middle;
  float reach = 0;
};

void Place(const motion::Poses& body, int frame, const motion::Skeleton& skeleton,
           std::vector<PlacedBone>* bones) {
  bones->clear();
  for (const motion::Bone& bone : skeleton.bones) {
    const motion::Vec3 from = body.at(frame, bone.parent), to = body.at(frame, bone.child);
    bones->push_back({from, to, (from + to) * 0.5f, Distance(from, to) * 0.5f});
  }
}

// The deepest overlap of two bodies.
double Depth(const std::vector<PlacedBone>& leader, const std::vector<PlacedBone>& follower,
             const std::vector<double>& radii) {
  double deepest = 0;
  for (size_t i = 0; i < leader.size(); ++i) {
    const PlacedBone& a = leader[i];
    for (size_t j = 0; j < follower.size(); ++j) {
      const PlacedBone& b = follower[j];
      // Most bones are so far apart that their spheres do not overlap.
      const auto near = static_cast<float>(radii[i] + radii[j] - deepest) + a.reach + b.reach;
      const motion::Vec3 apart = a.middle - b.middle;
      if (Dot(apart, apart) > (near + kSlack) * (near + kSlack)) continue;
      const double distance = SegmentDistance(a.from, a.to, b.from, b.to);
      deepest = std::max(deepest, radii[i] + radii[j] - distance);
    }
  }
  return deepest;
}

}  // namespace

Penetration MeasurePenetration(const motion::Poses& leader, const motion::Poses& follower,
                               const motion::Skeleton& skeleton,
                               const std::vector<motion::BodyPart>& parts) {
  const std::vector<double> radii = CapsuleRadii(skeleton, parts);
  std::vector<PlacedBone> leading, following;
  Penetration result;
  double touching = 0, sum = 0;
  for (int t = 0; t < leader.frame_count(); ++t) {
    Place(leader, t, skeleton, &leading);
    Place(follower, t, skeleton, &following);
    const double depth = Depth(leading, following, radii);
    if (depth <= 0) continue;
    ++touching;
    sum += depth;
    result.max_depth_metres = std::max(result.max_depth_metres, depth);
  }
  if (touching == 0) return result;
  result.frequency = touching / leader.frame_count();
  result.mean_depth_metres = sum / touching;
  return result;
}

namespace {

// A hand's joint is inside the hand, and captures have errors of centimetres.
constexpr double kReachMetres = 0.05;

bool IsLimb(const motion::BodyPart& part) {
  return part.name.find("arm") != std::string::npos || part.name.find("leg") != std::string::npos;
}

bool Touches(const motion::Poses& leader, int frame, motion::Vec3 end,
             const motion::Skeleton& skeleton, const std::vector<double>& radii) {
  for (size_t i = 0; i < skeleton.bones.size(); ++i) {
    const motion::Bone& bone = skeleton.bones[i];
    const double distance =
        SegmentDistance(leader.at(frame, bone.parent), leader.at(frame, bone.child), end, end);
    if (distance <= radii[i] + kReachMetres) return true;
  }
  return false;
}

}  // namespace

std::vector<int> LimbEnds(const motion::Skeleton& skeleton,
                          const std::vector<motion::BodyPart>& parts) {
  std::vector<bool> goes_on(static_cast<size_t>(skeleton.joint_count()));
  for (const motion::Bone& bone : skeleton.bones) goes_on[static_cast<size_t>(bone.parent)] = true;
  std::vector<int> ends;
  for (const motion::BodyPart& part : parts) {
    if (!IsLimb(part)) continue;
    for (const int joint : part.joints) {
      if (!goes_on[static_cast<size_t>(joint)]) ends.push_back(joint);
    }
  }
  return ends;
}

double TouchShare(const motion::Poses& leader, const motion::Poses& follower,
                  const motion::Skeleton& skeleton, const std::vector<motion::BodyPart>& parts) {
  const std::vector<int> ends = LimbEnds(skeleton, parts);
  if (ends.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> radii = CapsuleRadii(skeleton, parts);
  double touching = 0;
  for (int t = 0; t < follower.frame_count(); ++t) {
    const bool touches = std::any_of(ends.begin(), ends.end(), [&](int end) {
      return Touches(leader, t, follower.at(t, end), skeleton, radii);
    });
    if (touches) ++touching;
  }
  return touching / follower.frame_count();
}

}  // namespace duet::body
