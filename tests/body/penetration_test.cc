#include "model/body/penetration.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/base/random.h"
#include "model/motion/capsules.h"

namespace duet::body {
namespace {

TEST(PenetrationTest, MeasuresDepthAndFrequency) {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"a", "b"};
  skeleton.bones = {{0, 1}};
  const std::vector<motion::BodyPart> parts = {{"left_arm", {0, 1}}};
  // Parallel bones (radius 0.045 each) at 1 m, 0.05 m, 0.08 m and exactly touching at 0.09 m or
  // more.
  motion::Poses leader(0, 2), follower(0, 2);
  for (const float distance : {1.0f, 0.05f, 0.08f, 0.1f}) {
    leader.Append({{0, 0, 0}, {0, 1, 0}});
    follower.Append({{distance, 0, 0}, {distance, 1, 0}});
  }
  const Penetration penetration = MeasurePenetration(leader, follower, skeleton, parts);
  EXPECT_DOUBLE_EQ(penetration.frequency, 0.5);
  EXPECT_NEAR(penetration.max_depth_metres, 0.04, 1e-6);
  EXPECT_NEAR(penetration.mean_depth_metres, 0.025, 1e-6);
}

TEST(PenetrationTest, IsZeroForBodiesApart) {
  const motion::Poses leader(15, std::vector<motion::Vec3>(15, {0, 0, 0}));
  const motion::Poses follower(15, std::vector<motion::Vec3>(15, {1, 0, 0}));
  const Penetration penetration =
      MeasurePenetration(leader, follower, motion::SbuSkeleton(), motion::SbuParts());
  EXPECT_EQ(penetration.frequency, 0);
  EXPECT_EQ(penetration.mean_depth_metres, 0);
  EXPECT_EQ(penetration.max_depth_metres, 0);
}

// Bones that are passed over for their distance make no difference, not even in the last digit.
TEST(Penetration, IsThatOfEveryPairOfBones) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const std::vector<double> radii = CapsuleRadii(skeleton, motion::SbuParts());
  base::Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    motion::Poses bodies[2] = {motion::Poses(1, 15), motion::Poses(1, 15)};
    const double apart = random.Uniform(0, 1.5);
    for (motion::Poses& body : bodies) {
      for (motion::Vec3& joint : body.all()) {
        joint = {static_cast<float>(random.Normal(0.4)), static_cast<float>(random.Normal(0.4)),
                 static_cast<float>(random.Normal(0.4) + (&body == bodies ? 0 : apart))};
      }
    }
    double deepest = 0;
    for (size_t i = 0; i < radii.size(); ++i) {
      for (size_t j = 0; j < radii.size(); ++j) {
        const motion::Bone &a = skeleton.bones[i], &b = skeleton.bones[j];
        const double distance =
            motion::SegmentDistance(bodies[0].at(0, a.parent), bodies[0].at(0, a.child),
                                    bodies[1].at(0, b.parent), bodies[1].at(0, b.child));
        deepest = std::max(deepest, radii[i] + radii[j] - distance);
      }
    }
    EXPECT_EQ(
        MeasurePenetration(bodies[0], bodies[1], skeleton, motion::SbuParts()).max_depth_metres,
        deepest);
  }
}

}  // namespace
}  // namespace duet::body
