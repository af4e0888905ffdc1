#include "tests/support/test_motion.h"

#include <algorithm>
#include <cmath>

namespace duet::test {
namespace {

// A direction tilted from straight down: forwards (+z) and to the person's left (+x).
motion::Vec3 Down(double forwards, double left) {
  const double s = std::sin(forwards), c = std::cos(forwards);
  return {static_cast<float>(std::sin(left)), static_cast<float>(-c * std::cos(left)),
          static_cast<float>(s * std::cos(left))};
}

// One frame of a person that faces +z with the torso at the origin; `phase` in radians.
void Pose(double phase, motion::Vec3* p) {
  const double sway = std::sin(phase), lift = 0.5 + 0.5 * std::sin(phase + 1);
  const motion::Vec3 up = -Down(-0.1 - 0.1 * sway, 0.05 * sway);
  p[2] = {0, 0, 0};
  p[1] = p[2] + 0.216f * up;
  p[0] = p[1] + 0.211f * -Down(0.1 * sway, 0);
  for (int side : {0, 1}) {
    const float x = side == 0 ? 1.0f : -1.0f;
    const double out = side == 0 ? 1 : -1;
    const double swing = side == 0 ? sway : -sway;
    motion::Vec3* arm = p + 3 + 3 * side;
    arm[0] = p[1] + 0.151f * motion::RotateY({x, 0, 0}, 0.2 * sway);
    arm[1] = arm[0] + 0.29f * Down(0.9 * swing, out * (0.15 + 0.4 * lift));
    arm[2] = arm[1] + 0.28f * Down(0.9 * swing + 0.3 + 0.8 * lift, out * 0.1);
    motion::Vec3* leg = p + 9 + 3 * side;
    leg[0] = p[2] + 0.237f * Down(-0.05, out * (0.42 + 0.05 * sway));
    leg[1] = leg[0] + 0.43f * Down(-0.6 * swing, out * 0.05);
    leg[2] = leg[1] + 0.41f * Down(-0.6 * swing - 0.1 - 0.5 * lift, out * 0.02);
  }
}

}  // namespace

motion::Clip MakePerson(const PersonOptions& options) {
  motion::Clip clip;
  clip.joint_names = motion::SbuSkeleton().joint_names;
  clip.frame_rate_hz = options.frame_rate_hz;
  clip.poses = motion::Poses(options.frames, clip.joint_count());
  for (int frame = 0; frame < options.frames; ++frame) {
    const double t = frame / std::max(1.0, options.frames - 1.0);
    motion::Vec3* pose = &clip.at(frame, 0);
    Pose(6.28 * t, pose);
    for (int j = 0; j < clip.joint_count(); ++j) {
      pose[j] = options.at + RotateY(pose[j], options.yaw + options.turn * t);
    }
  }
  return clip;
}

float LargestDistance(const motion::Clip& a, const motion::Clip& b) {
  if (a.poses.all().size() != b.poses.all().size()) return 1e9f;
  float largest = 0;
  for (std::size_t i = 0; i < a.poses.all().size(); ++i) {
    largest = std::max(largest, Distance(a.poses.all()[i], b.poses.all()[i]));
  }
  return largest;
}

}  // namespace duet::test
