#include "model/cleanup/upright.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/cleanup/low_pass.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr float kRadiansPerDegree = 0.01745329252f;

Vec3 BetweenFeet(const motion::JointPair& feet, const motion::Poses& poses, int frame) {
  return Lerp(poses.at(frame, feet.left), poses.at(frame, feet.right), 0.5f);
}

// Rodrigues' formula; `axis` of length 1.
Vec3 Rotate(Vec3 v, Vec3 axis, float radians) {
  const float c = std::cos(radians), s = std::sin(radians);
  return v * c + Cross(axis, v) * s + axis * (Dot(axis, v) * (1 - c));
}

}  // namespace

std::vector<Vec3> LastingLean(const motion::JointPair& feet, int chest, const motion::Poses& poses,
                              double sigma_frames) {
  std::vector<Vec3> trunk;
  for (int t = 0; t < poses.frame_count(); ++t) {
    trunk.push_back(poses.at(t, chest) - BetweenFeet(feet, poses, t));
  }
  trunk = LowPass(trunk, sigma_frames);
  for (Vec3& direction : trunk) {
    const float length = Norm(direction);
    direction = length > 0 ? direction / length : Vec3{0, 1, 0};
  }
  return trunk;
}

void SetUpright(const motion::Skeleton& skeleton, const Body& body, const UprightOptions& options,
                const Timing& timing, motion::Poses* poses) {
  if (!skeleton.feet || !body.chest) return;
  const std::vector<Vec3> lean =
      LastingLean(*skeleton.feet, *body.chest, *poses, timing.Frames(options.sigma_seconds));
  const float free = static_cast<float>(options.free_degrees) * kRadiansPerDegree;
  const float most = static_cast<float>(options.most_degrees) * kRadiansPerDegree;
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const Vec3 trunk = lean[static_cast<std::size_t>(t)];
    const Vec3 axis = Cross(trunk, Vec3{0, 1, 0});  // turning about it lifts the trunk
    const float sine = Norm(axis);
    const float angle = std::atan2(sine, trunk.y);
    const float too_far = (angle - SoftLimit(angle, free, most)) * EaseIn(timing, t);
    if (too_far == 0 || sine == 0) continue;
    const Vec3 pivot = BetweenFeet(*skeleton.feet, *poses, t);
    for (Vec3& joint : (*poses)[t]) joint = pivot + Rotate(joint - pivot, axis / sine, too_far);
  }
}

}  // namespace duet::cleanup
