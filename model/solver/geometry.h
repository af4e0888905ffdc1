#ifndef DUET_MODEL_SOLVER_GEOMETRY_H_
#define DUET_MODEL_SOLVER_GEOMETRY_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/vec3.h"

// Joints, directions and angles that the parts of the solver share.
namespace duet::solver {

// Shorter vectors have no direction.
inline constexpr float kNoDirection = 1e-5f;

inline motion::Vec3 JointAt(absl::Span<const motion::Vec3> pose, int joint) {
  return pose[static_cast<std::size_t>(joint)];
}
inline bool Contains(const std::vector<int>& joints, int joint) {
  return std::find(joints.begin(), joints.end(), joint) != joints.end();
}
// The part along the floor.
inline motion::Vec3 Level(motion::Vec3 v) { return {v.x, 0, v.z}; }
// Of length 1, or {} for a vector without a direction.
inline motion::Vec3 Unit(motion::Vec3 v) {
  const float length = Norm(v);
  return length > kNoDirection ? v / length : motion::Vec3{};
}
// The part across an axis of length 1.
inline motion::Vec3 Across(motion::Vec3 v, motion::Vec3 axis) { return v - axis * Dot(v, axis); }
// 0 to 1 with level ends, for `t` from 0 to 1.
inline float SmoothStep(float t) {
  const float u = std::clamp(t, 0.0f, 1.0f);
  return u * u * (3 - 2 * u);
}
// The angle about an axis of length 1 from `from` to `to`, radians, in (-pi, pi].
inline double AngleAbout(motion::Vec3 axis, motion::Vec3 from, motion::Vec3 to) {
  return std::atan2(double{Dot(axis, Cross(from, to))},
                    double{Dot(Across(from, axis), Across(to, axis))});
}

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_GEOMETRY_H_
