#include "model/evaluation/experiments/made_body.h"

#include <algorithm>
#include <cmath>

namespace duet::evaluation::experiments {
namespace {

// Lengths of a person of 1.7 m.
constexpr float kHalfHips = 0.09f, kThigh = 0.42f, kShin = 0.41f;
constexpr float kTorso = 0.22f, kNeck = 0.46f, kHead = 0.64f;  // above the hips, along the trunk
constexpr float kShoulderHeight = 0.42f, kHalfShoulders = 0.17f;
constexpr float kUpperArm = 0.28f, kForearm = 0.25f;

// Turns forwards about the axis from left to right: up goes to -z.
motion::Vec3 Bend(motion::Vec3 p, double radians) {
  const auto c = static_cast<float>(std::cos(radians)), s = static_cast<float>(std::sin(radians));
  return {p.x, c * p.y + s * p.z, c * p.z - s * p.y};
}

// The middle joint of a limb of two bones whose end is as near to `*end` as they reach; it lies
// towards `forwards`.
motion::Vec3 MiddleJoint(motion::Vec3 start, motion::Vec3 forwards, motion::Vec3* end) {
  const motion::Vec3 line = *end - start;
  const float length =
      std::clamp(Norm(line), std::abs(kThigh - kShin) + 1e-3f, kThigh + kShin - 1e-3f);
  const motion::Vec3 along = line / Norm(line);
  *end = start + along * length;
  const float part = (kThigh * kThigh - kShin * kShin + length * length) / (2 * length);
  const float off = std::sqrt(std::max(0.0f, kThigh * kThigh - part * part));
  const motion::Vec3 side = forwards - along * Dot(forwards, along);
  return start + along * part + side / Norm(side) * off;
}

// Shoulder, elbow, hand in the trunk's coordinates; `side` is -1 on the left.
struct ArmJoints {
  motion::Vec3 shoulder, elbow, hand;
};
ArmJoints PoseArm(const MadeArm& arm, float side) {
  const auto direction = [&](double swing) {
    const auto out = static_cast<float>(std::sin(arm.spread)) * side;
    const double down = std::cos(arm.spread);
    return motion::Vec3{out, static_cast<float>(-down * std::cos(swing)),
                        static_cast<float>(-down * std::sin(swing))};
  };
  ArmJoints joints;
  joints.shoulder = {side * kHalfShoulders, kShoulderHeight, 0};
  joints.elbow = joints.shoulder + direction(arm.swing) * kUpperArm;
  joints.hand = joints.elbow + direction(arm.swing + arm.elbow) * kForearm;
  return joints;
}

}  // namespace

std::vector<motion::Vec3> PoseOf(const MadeBody& body) {
  const auto trunk = [&](motion::Vec3 p) {
    return body.hips + RotateY(Bend(p, body.bend), body.yaw);
  };
  const motion::Vec3 forwards = RotateY(motion::Vec3{0, 0, -1}, body.yaw);
  const motion::Vec3 left_hip = body.hips + RotateY(motion::Vec3{-kHalfHips, 0, 0}, body.yaw);
  const motion::Vec3 right_hip = body.hips + RotateY(motion::Vec3{kHalfHips, 0, 0}, body.yaw);
  motion::Vec3 left_foot = body.left_foot, right_foot = body.right_foot;
  const motion::Vec3 left_knee = MiddleJoint(left_hip, forwards, &left_foot);
  const motion::Vec3 right_knee = MiddleJoint(right_hip, forwards, &right_foot);
  const ArmJoints left = PoseArm(body.left_arm, -1), right = PoseArm(body.right_arm, 1);
  return {trunk({0, kHead, 0}),
          trunk({0, kNeck, 0}),
          trunk({0, kTorso, 0}),
          trunk(left.shoulder),
          trunk(left.elbow),
          trunk(left.hand),
          trunk(right.shoulder),
          trunk(right.elbow),
          trunk(right.hand),
          left_hip,
          left_knee,
          left_foot,
          right_hip,
          right_knee,
          right_foot};
}

}  // namespace duet::evaluation::experiments
