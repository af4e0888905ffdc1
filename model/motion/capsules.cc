#include "model/motion/capsules.h"

#include <algorithm>
#include <cstddef>
#include <string>

namespace duet::motion {
namespace {

constexpr double kArmRadius = 0.045, kLegRadius = 0.065, kTrunkRadius = 0.11, kHeadRadius = 0.09;
// Segments whose squared length is below this are points (a micrometre squared).
constexpr double kPointLength = 1e-12;
// Squared sine of the angle below which two segments count as parallel.
constexpr double kParallel = 1e-9;

double Clamp01(double value) { return std::clamp(value, 0.0, 1.0); }

double RadiusOf(const Skeleton& skeleton, const std::vector<BodyPart>& parts, const Bone& bone) {
  if (skeleton.joint_names[static_cast<std::size_t>(bone.child)] == "head") return kHeadRadius;
  for (const BodyPart& part : parts) {
    if (std::find(part.joints.begin(), part.joints.end(), bone.child) == part.joints.end()) {
      continue;
    }
    // Bones that join a limb to the trunk (neck to shoulder, torso to hip) belong to the trunk.
    if (std::find(part.joints.begin(), part.joints.end(), bone.parent) == part.joints.end()) {
      return kTrunkRadius;
    }
    if (part.name.find("arm") != std::string::npos) return kArmRadius;
    if (part.name.find("leg") != std::string::npos) return kLegRadius;
  }
  return kTrunkRadius;
}

}  // namespace

ClosestPoints FindClosestPoints(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1) {
  // Minimises |a0 + s u - b0 - t v| over the unit square: takes the unconstrained optimum of s and
  // clamps it, takes the best t for that s and clamps it, and then the best s for that t.
  const Vec3 u = a1 - a0, v = b1 - b0, w = a0 - b0;
  const double uu = Dot(u, u), vv = Dot(v, v), uv = Dot(u, v), uw = Dot(u, w), vw = Dot(v, w);
  double s = 0, t = 0;
  if (uu > kPointLength) {
    const double parallel = uu * vv - uv * uv;
    if (vv <= kPointLength) {
      s = Clamp01(-uw / uu);
    } else {
      if (parallel > kParallel * uu * vv) s = Clamp01((uv * vw - vv * uw) / parallel);
      t = Clamp01((uv * s + vw) / vv);
      s = Clamp01((uv * t - uw) / uu);
    }
  } else if (vv > kPointLength) {
    t = Clamp01(vw / vv);
  }
  const Vec3 along_a = u * static_cast<float>(s), along_b = v * static_cast<float>(t);
  return {a0 + along_a, b0 + along_b, Norm(w + along_a - along_b)};
}

double SegmentDistance(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1) {
  return FindClosestPoints(a0, a1, b0, b1).distance;
}

std::vector<double> CapsuleRadii(const Skeleton& skeleton, const std::vector<BodyPart>& parts) {
  std::vector<double> radii;
  for (const Bone& bone : skeleton.bones) radii.push_back(RadiusOf(skeleton, parts, bone));
  return radii;
}

}  // namespace duet::motion
