#include "model/motion/poses.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::motion {
namespace {

// Three frames of two joints, told apart by x.
Poses Six() { return Poses(2, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}}); }

Vec3 X(float x) { return {x, 0, 0}; }

TEST(Poses, KnowTheirShape) {
  const Poses poses = Six();
  EXPECT_EQ(poses.frame_count(), 3);
  EXPECT_EQ(poses.joint_count(), 2);
  EXPECT_FALSE(poses.empty());
  EXPECT_EQ(Poses().frame_count(), 0);
  EXPECT_TRUE(Poses().empty());
}

TEST(Poses, BeginAtTheOrigin) {
  const Poses poses(2, 3);
  EXPECT_EQ(poses.frame_count(), 2);
  EXPECT_EQ(poses.joint_count(), 3);
  for (const Vec3& position : poses.all()) EXPECT_EQ(position, Vec3{});
  EXPECT_EQ(poses.all().size(), 6u);
}

TEST(Poses, HoldFrameAfterFrame) {
  const Poses poses = Six();
  EXPECT_THAT(poses[1], ElementsAre(X(2), X(3)));
  EXPECT_EQ(poses.at(2, 1), X(5));
  EXPECT_THAT(poses.frames(1, 2), ElementsAre(X(2), X(3), X(4), X(5)));
  EXPECT_THAT(poses.frames(3, 0), IsEmpty());
}

TEST(Poses, AreWrittenThroughFramesAndJoints) {
  Poses poses(2, 2);
  poses.at(0, 1) = X(1);
  poses[1][0] = X(2);
  for (Vec3& position : poses.all()) position.y = 7;
  EXPECT_THAT(poses.all(), ElementsAre(Vec3{0, 7, 0}, Vec3{1, 7, 0}, Vec3{2, 7, 0}, Vec3{0, 7, 0}));
}

TEST(Poses, GrowAtTheEndAndShrinkAtTheFront) {
  Poses poses(0, 2);
  EXPECT_EQ(poses.joint_count(), 2);
  poses.Append(Six().frames(1, 2));
  poses.Append(Six()[0]);
  EXPECT_THAT(poses.all(), ElementsAre(X(2), X(3), X(4), X(5), X(0), X(1)));
  poses.DropFront(2);
  EXPECT_EQ(poses, Poses(2, {X(0), X(1)}));
  poses.DropFront(1);
  EXPECT_TRUE(poses.empty());
  EXPECT_EQ(poses.joint_count(), 2);
}

TEST(Poses, AreEqualInShapeAndPositions) {
  EXPECT_EQ(Six(), Six());
  EXPECT_NE(Six(), Poses(3, {X(0), X(1), X(2), X(3), X(4), X(5)}));
  Poses moved = Six();
  moved.at(1, 1).z = 1;
  EXPECT_NE(Six(), moved);
}

}  // namespace
}  // namespace duet::motion
