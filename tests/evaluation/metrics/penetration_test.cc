#include "model/evaluation/metrics/penetration.h"

#include <gtest/gtest.h>

namespace duet::evaluation::metrics {
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

}  // namespace
}  // namespace duet::evaluation::metrics
