#include "tests/support/sample_motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace duet::test {
namespace {

// Standing, facing -z (the left hip on the -x side), arms hanging. Relative to the torso.
const std::vector<motion::Vec3>& StandingPose() {
  static const auto* const kPose = new std::vector<motion::Vec3>{
      {0, 0.43f, 0},       {0, 0.22f, 0},       {0, 0, 0},          {-0.15f, 0.22f, 0},
      {-0.18f, -0.07f, 0}, {-0.18f, -0.35f, 0}, {0.15f, 0.22f, 0},  {0.18f, -0.07f, 0},
      {0.18f, -0.35f, 0},  {-0.09f, -0.2f, 0},  {-0.1f, -0.62f, 0}, {-0.1f, -1.02f, 0},
      {0.09f, -0.2f, 0},   {0.1f, -0.62f, 0},   {0.1f, -1.02f, 0}};
  return *kPose;
}

}  // namespace

std::vector<motion::Vec3> SwayingPose(double seconds) {
  const float t = static_cast<float>(seconds);
  std::vector<motion::Vec3> pose = StandingPose();
  const motion::Vec3 root = {0.1f + 0.2f * std::sin(0.7f * t), 1.05f + 0.02f * std::sin(3 * t),
                             0.8f + 0.15f * std::cos(0.5f * t)};
  for (std::size_t j = 0; j < pose.size(); ++j) {
    // The further below the neck, the wider the swing; left and right in opposite phase.
    const float side = pose[j].x < 0 ? 1.0f : -1.0f;
    pose[j].z += 0.15f * side * (0.22f - pose[j].y) * std::sin(4 * t);
    pose[j] = root + RotateY(pose[j], 0.5 + 0.3 * std::sin(0.4 * seconds));
  }
  return pose;
}

motion::Poses SwayingMotion(int frames, double frame_rate_hz) {
  motion::Poses motion(0, static_cast<int>(StandingPose().size()));
  for (int frame = 0; frame < frames; ++frame) motion.Append(SwayingPose(frame / frame_rate_hz));
  return motion;
}

motion::Clip SwayingClip(int frames, double frame_rate_hz) {
  motion::Clip clip;
  clip.joint_names = motion::SbuSkeleton().joint_names;
  clip.frame_rate_hz = frame_rate_hz;
  clip.poses = SwayingMotion(frames, frame_rate_hz);
  return clip;
}

motion::Poses SteppingMotion(const std::vector<double>& steps, int frames, double frame_rate_hz) {
  constexpr double kStepSeconds = 0.3, kStepSpeed = 1;
  const motion::JointPair feet = *motion::SbuSkeleton().feet;
  motion::Poses motion(0, static_cast<int>(StandingPose().size()));
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<motion::Vec3> pose = StandingPose();
    for (motion::Vec3& position : pose) position.y += 1.05f;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const double moving = frame / frame_rate_hz - steps[i] + kStepSeconds;
      const int foot = i % 2 == 0 ? feet.left : feet.right;
      pose[static_cast<std::size_t>(foot)].z -=
          static_cast<float>(kStepSpeed * std::clamp(moving, 0.0, kStepSeconds));
    }
    motion.Append(pose);
  }
  return motion;
}

}  // namespace duet::test
