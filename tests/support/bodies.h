#ifndef DUET_TESTS_SUPPORT_BODIES_H_
#define DUET_TESTS_SUPPORT_BODIES_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "gtest/gtest.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"
#include "tests/support/puppet.h"

// Puppets: a person of the SBU skeleton who stands or walks, and what to do to them.
namespace duet::test {

constexpr double kRate = 15;
constexpr int kFrames = 46;

// The ankle of a puppet that stands: the floor of its feet.
constexpr double kAnkle = 0.08;

inline PuppetPose Standing() {
  PuppetPose pose;
  pose.torso = {0, 1.1, 0};
  pose.left_foot.target = {0.12, kAnkle, 0};
  pose.right_foot.target = {-0.12, kAnkle, 0};
  pose.left_hand.target = {0.25, -0.45, 0.1};
  pose.right_hand.target = {-0.25, -0.45, 0.1};
  return pose;
}

// `shape` changes the standing pose at a time in seconds.
inline motion::Poses Puppet(const std::function<void(double, PuppetPose*)>& shape = {},
                            int frames = kFrames) {
  motion::Poses poses(0, 15);
  for (int t = 0; t < frames; ++t) {
    PuppetPose pose = Standing();
    if (shape) shape(t / kRate, &pose);
    poses.Append(PosePuppet(pose));
  }
  return poses;
}

// Every frame's joints by a rule.
inline motion::Poses Changed(motion::Poses poses,
                             const std::function<motion::Vec3(int, motion::Vec3)>& rule) {
  for (int t = 0; t < poses.frame_count(); ++t) {
    for (motion::Vec3& joint : poses[t]) joint = rule(t, joint);
  }
  return poses;
}

inline motion::Poses Moved(const motion::Poses& poses, motion::Vec3 way) {
  return Changed(poses, [&](int, motion::Vec3 joint) { return joint + way; });
}

// Leans forwards (towards +z) about the floor under the origin.
inline motion::Vec3 LeanForwards(motion::Vec3 joint, double degrees) {
  const float c = static_cast<float>(std::cos(degrees * 3.14159265 / 180));
  const float s = static_cast<float>(std::sin(degrees * 3.14159265 / 180));
  return {joint.x, c * joint.y - s * joint.z, s * joint.y + c * joint.z};
}

inline float LargestDistance(const motion::Poses& a, const motion::Poses& b, int from = 0) {
  EXPECT_EQ(a.all().size(), b.all().size());
  float largest = 0;
  for (int t = from; t < a.frame_count(); ++t) {
    for (int j = 0; j < a.joint_count(); ++j) {
      largest = std::max(largest, Distance(a.at(t, j), b.at(t, j)));
    }
  }
  return largest;
}

// The farthest that any joint moves from one frame to the next, metres.
inline float LargestStep(const motion::Poses& poses) {
  float largest = 0;
  for (int t = 1; t < poses.frame_count(); ++t) {
    for (int j = 0; j < poses.joint_count(); ++j) {
      largest = std::max(largest, Distance(poses.at(t, j), poses.at(t - 1, j)));
    }
  }
  return largest;
}

// The most that any bone's length differs, metres.
inline float LargestLengthChange(const motion::Poses& a, const motion::Poses& b) {
  float largest = 0;
  for (int t = 0; t < a.frame_count(); ++t) {
    for (const motion::Bone& bone : motion::SbuSkeleton().bones) {
      largest = std::max(largest, std::abs(Distance(a.at(t, bone.parent), a.at(t, bone.child)) -
                                           Distance(b.at(t, bone.parent), b.at(t, bone.child))));
    }
  }
  return largest;
}

// The angle between the vertical and the way from between the feet to the neck, degrees.
inline double LeanDegrees(const motion::Poses& poses, int frame) {
  const motion::Vec3 trunk =
      poses.at(frame, 1) - Lerp(poses.at(frame, 11), poses.at(frame, 14), 0.5f);
  return std::acos(trunk.y / Norm(trunk)) * 180 / 3.14159265;
}

// Skeletons that lack something.
inline motion::Skeleton WithoutHips() {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  skeleton.hips.reset();
  return skeleton;
}
inline motion::Skeleton WithoutFeet() {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  skeleton.feet.reset();
  return skeleton;
}

}  // namespace duet::test

#endif  // DUET_TESTS_SUPPORT_BODIES_H_
