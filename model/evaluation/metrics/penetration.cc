#include "model/evaluation/metrics/penetration.h"

#include <algorithm>
#include <cstddef>

namespace duet::evaluation::metrics {
namespace {

constexpr double kArmRadius = 0.045, kLegRadius = 0.065, kTrunkRadius = 0.11, kHeadRadius = 0.09;
// Segments whose squared length is below this are points (a micrometre squared).
constexpr double kPointLength = 1e-12;
// Squared sine of the angle below which two segments count as parallel.
constexpr double kParallel = 1e-9;

double Clamp01(double value) { return std::clamp(value, 0.0, 1.0); }

double RadiusOf(const motion::Skeleton& skeleton, const std::vector<motion::BodyPart>& parts,
                const motion::Bone& bone) {
  if (skeleton.joint_names[static_cast<size_t>(bone.child)] == "head") return kHeadRadius;
  for (const motion::BodyPart& part : parts) {
    if (std::find(part.joints.begin(), part.joints.end(), bone.child) == part.joints.end()) {
      continue;
    }
    // The bones that join a limb to the trunk (neck to shoulder, torso to hip) are trunk.
    if (std::find(part.joints.begin(), part.joints.end(), bone.parent) == part.joints.end()) {
      return kTrunkRadius;
    }
    if (part.name.find("arm") != std::string::npos) return kArmRadius;
    if (part.name.find("leg") != std::string::npos) return kLegRadius;
  }
  return kTrunkRadius;
}

// The deepest overlap of two bodies in one frame.
double FrameDepth(const motion::Poses& leader, const motion::Poses& follower, int frame,
                  const motion::Skeleton& skeleton, const std::vector<double>& radii) {
  double deepest = 0;
  for (size_t i = 0; i < skeleton.bones.size(); ++i) {
    const motion::Bone& a = skeleton.bones[i];
    for (size_t j = 0; j < skeleton.bones.size(); ++j) {
      const motion::Bone& b = skeleton.bones[j];
      const double distance =
          SegmentDistance(leader.at(frame, a.parent), leader.at(frame, a.child),
                          follower.at(frame, b.parent), follower.at(frame, b.child));
      deepest = std::max(deepest, radii[i] + radii[j] - distance);
    }
  }
  return deepest;
}

}  // namespace

double SegmentDistance(motion::Vec3 a0, motion::Vec3 a1, motion::Vec3 b0, motion::Vec3 b1) {
  // Minimises |a0 + s u - b0 - t v| over the unit square: the free optimum in s, clamped; the best
  // t for it; if that had to be clamped, the best s for it.
  const motion::Vec3 u = a1 - a0, v = b1 - b0, w = a0 - b0;
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
  return Norm(w + u * static_cast<float>(s) - v * static_cast<float>(t));
}

std::vector<double> CapsuleRadii(const motion::Skeleton& skeleton,
                                 const std::vector<motion::BodyPart>& parts) {
  std::vector<double> radii;
  for (const motion::Bone& bone : skeleton.bones) {
    radii.push_back(RadiusOf(skeleton, parts, bone));
  }
  return radii;
}

Penetration MeasurePenetration(const motion::Poses& leader, const motion::Poses& follower,
                               const motion::Skeleton& skeleton,
                               const std::vector<motion::BodyPart>& parts) {
  const std::vector<double> radii = CapsuleRadii(skeleton, parts);
  Penetration result;
  double touching = 0, sum = 0;
  for (int t = 0; t < leader.frame_count(); ++t) {
    const double depth = FrameDepth(leader, follower, t, skeleton, radii);
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

}  // namespace duet::evaluation::metrics
