#ifndef DUET_TESTS_ENGINE_LEADER_MOTION_H_
#define DUET_TESTS_ENGINE_LEADER_MOTION_H_

#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// A person of eight joints, root first, who stands upright with the right hand stretched forwards:
// root and hips 1 m high, legs of 1.2 m with the hips, the neck 0.5 m above the root.
inline motion::Skeleton PlainSkeleton() {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"root",      "neck",       "left_hip",  "right_hip",
                          "left_foot", "right_foot", "left_hand", "right_hand"};
  skeleton.bones = {{0, 1}, {0, 2}, {0, 3}, {2, 4}, {3, 5}, {0, 6}, {0, 7}};
  skeleton.hips = motion::JointPair{2, 3};
  skeleton.feet = motion::JointPair{4, 5};
  return skeleton;
}

inline motion::Poses Standing(int frames) {
  const std::vector<motion::Vec3> pose = {{0, 1, 0},    {0, 1.5f, 0},   {-0.2f, 1, 0},
                                          {0.2f, 1, 0}, {-0.2f, 0, 0},  {0.2f, 0, 0},
                                          {0.3f, 1, 0}, {0.3f, 1, 0.4f}};
  motion::Poses poses(0, 8);
  for (int t = 0; t < frames; ++t) poses.Append(pose);
  return poses;
}

// The same person, gliding along x.
inline motion::Poses Walking(int frames, double metres_per_frame) {
  motion::Poses poses = Standing(frames);
  for (int t = 0; t < frames; ++t) {
    for (motion::Vec3& joint : poses[t]) joint.x += static_cast<float>(t * metres_per_frame);
  }
  return poses;
}

}  // namespace duet::engine

#endif  // DUET_TESTS_ENGINE_LEADER_MOTION_H_
