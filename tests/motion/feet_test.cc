#include "model/motion/feet.h"

#include "gmock/gmock.h"
#include "tests/support/matchers.h"

namespace duet::motion {
namespace {

TEST(LowerFootTest, IsTheLowerOfBothInEachFrame) {
  Poses poses(3, 3);
  const JointPair feet{0, 2};
  for (int t = 0; t < 3; ++t) {
    poses.at(t, 0).y = static_cast<float>(t);
    poses.at(t, 1).y = -5;  // no foot
    poses.at(t, 2).y = 1.5f;
  }
  EXPECT_THAT(LowerFoot(feet, poses), ElementsAre(0, 1, 1.5f));
  EXPECT_EQ(LowestFoot(feet, poses), 0);
  poses.at(2, 2).y = -1;
  EXPECT_EQ(LowestFoot(feet, poses), -1);
  EXPECT_GT(LowestFoot(feet, Poses(0, 3)), 1e30f);
}

}  // namespace
}  // namespace duet::motion
