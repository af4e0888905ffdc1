#include "model/motion/limb_lengths.h"

#include <gmock/gmock.h>

#include "tests/support/matchers.h"

namespace duet::motion {
namespace {

// A chain of three joints, its bones listed child first.
Skeleton Chain() {
  Skeleton skeleton;
  skeleton.joint_names = {"root", "middle", "end"};
  skeleton.bones = {{1, 2}, {0, 1}};
  skeleton.root = 0;
  return skeleton;
}

TEST(LimbLengthsTest, MedianIsOverTheFrames) {
  const Poses poses(3, {{0, 0, 0},
                        {1, 0, 0},
                        {1, 2, 0},  // 2, 1
                        {0, 0, 0},
                        {3, 0, 0},
                        {3, 9, 0},  // 9, 3
                        {0, 0, 0},
                        {2, 0, 0},
                        {2, 3, 0}});  // 3, 2
  EXPECT_THAT(MedianBoneLengths(Chain(), poses), ElementsAre(FloatEq(3), FloatEq(2)));
}

TEST(LimbLengthsTest, SettingKeepsRootAndDirections) {
  Poses poses(3, {{1, 1, 1}, {1, 3, 1}, {5, 3, 1}});
  SetBoneLengths(Chain(), {0.5f, 1}, &poses);
  EXPECT_THAT(poses.all(), ElementsAre(Vec3{1, 1, 1}, Vec3{1, 2, 1}, Vec3{1.5f, 2, 1}));
}

TEST(LimbLengthsTest, BoneWithoutDirectionStaysPut) {
  Poses poses(3, {{1, 1, 1}, {1, 1, 1}, {1, 2, 1}});
  SetBoneLengths(Chain(), {3, 1}, &poses);
  EXPECT_THAT(poses.all(), ElementsAre(Vec3{1, 1, 1}, Vec3{1, 1, 1}, Vec3{1, 4, 1}));
}

}  // namespace
}  // namespace duet::motion
