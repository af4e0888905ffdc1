#include "model/body/penetration.h"

#include <algorithm>
#include <cstddef>

#include "model/motion/capsules.h"

namespace duet::body {
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

}  // namespace duet::body
