#include "model/body/limbs.h"

#include <utility>

#include "gmock/gmock.h"
#include "model/motion/capsules.h"
#include "tests/support/bodies.h"

namespace duet::body {
namespace {

using motion::Vec3;
using test::LargestDistance;
using test::LargestLengthChange;
using test::WithoutFeet;
using test::WithoutHips;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

// A skeleton by joints with the index of each one's parent, the first the root.
motion::Skeleton Tree(std::vector<std::pair<std::string, int>> joints) {
  motion::Skeleton skeleton;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    skeleton.joint_names.push_back(joints[j].first);
    if (joints[j].second >= 0) skeleton.bones.push_back({joints[j].second, static_cast<int>(j)});
  }
  return skeleton;
}

TEST(FindBody, KnowsTheSbuSkeleton) {
  const Body body = FindBody(motion::SbuSkeleton());
  EXPECT_EQ(body.chest, 1);
  ASSERT_EQ(body.legs.size(), 2u);
  EXPECT_EQ(body.legs[1].upper, 12);
  EXPECT_EQ(body.legs[1].middle, 13);
  EXPECT_EQ(body.legs[1].end, 14);
  ASSERT_EQ(body.arms.size(), 2u);
  EXPECT_EQ(body.arms[0].upper, 3);
  EXPECT_EQ(body.arms[0].middle, 4);
  EXPECT_EQ(body.arms[0].end, 5);
  ASSERT_TRUE(body.neck.has_value());
  EXPECT_EQ(body.neck->base, 1);
  EXPECT_EQ(body.neck->head, 0);
}

TEST(FindBody, FindsLimbsAmongSpineCollarsToesAndFingers) {
  motion::Skeleton skeleton =
      Tree({{"pelvis", -1},  {"spine", 0},    {"chest", 1},      {"neck", 2},
            {"Head", 3},     {"head_end", 4},  // 5
            {"collar.L", 2}, {"arm.L", 6},    {"forearm.L", 7},  {"hand.L", 8},
            {"index.L", 9},  {"thumb.L", 9},                                      // 11
            {"collar.R", 2}, {"arm.R", 12},   {"forearm.R", 13}, {"hand.R", 14},  // 15
            {"thigh.L", 0},  {"shin.L", 16},  {"foot.L", 17},    {"toe.L", 18},
            {"thigh.R", 0},  {"shin.R", 20},  {"foot.R", 21},    {"toe.R", 22}});
  skeleton.hips = motion::JointPair{16, 20};
  skeleton.feet = motion::JointPair{18, 22};
  const Body body = FindBody(skeleton);
  EXPECT_EQ(body.chest, 2);
  ASSERT_EQ(body.arms.size(), 2u);
  EXPECT_EQ(body.arms[0].end, 9);
  EXPECT_THAT(body.arms[0].beyond, ElementsAre(10, 11));
  EXPECT_EQ(body.arms[1].upper, 13);
  ASSERT_EQ(body.legs.size(), 2u);
  EXPECT_EQ(body.legs[0].upper, 16);
  EXPECT_THAT(body.legs[0].beyond, ElementsAre(19));
  ASSERT_TRUE(body.neck.has_value());
  EXPECT_EQ(body.neck->base, 3);
  EXPECT_EQ(body.neck->head, 4);
  EXPECT_THAT(body.neck->branch, ElementsAre(4, 5));
}

TEST(FindBody, AnArmEndsAtItsWrist) {
  motion::Skeleton skeleton = Tree({{"hips", -1},
                                    {"chest", 0},
                                    {"head", 1},
                                    {"left_shoulder", 1},
                                    {"left_elbow", 3},
                                    {"left_wrist", 4},
                                    {"left_hand", 5},
                                    {"right_shoulder", 1},
                                    {"right_elbow", 7},
                                    {"right_wrist", 8},
                                    {"right_hand", 9},
                                    {"left_hip", 0},
                                    {"right_hip", 0}});
  skeleton.hips = motion::JointPair{11, 12};
  const Body body = FindBody(skeleton);
  ASSERT_EQ(body.arms.size(), 2u);
  EXPECT_EQ(body.arms[0].upper, 3);
  EXPECT_EQ(body.arms[0].end, 5);
  EXPECT_THAT(body.arms[0].beyond, ElementsAre(6));
  ASSERT_TRUE(body.shoulders.has_value());
  EXPECT_EQ(*body.shoulders, (motion::JointPair{3, 7}));
}

class ReachTest : public ::testing::Test {
 protected:
  void ReachFor(Vec3 target) { Reach(leg_, target, {0, 0, 1}, poses_[0]); }
  const Limb leg_ = FindBody(motion::SbuSkeleton()).legs[0];
  motion::Poses poses_ = test::Puppet({}, 1);
  const motion::Poses before_ = poses_;
};

TEST_F(ReachTest, ReachesTheTargetAndKeepsBoneLengths) {
  const Vec3 target = poses_.at(0, 11) + Vec3{0.1f, 0.15f, -0.2f};
  ReachFor(target);
  EXPECT_LT(Distance(poses_.at(0, 11), target), 1e-5f);
  EXPECT_LT(LargestLengthChange(poses_, before_), 1e-6f);
  EXPECT_GT(poses_.at(0, 10).z, poses_.at(0, 11).z);  // the knee still bends forwards
}

TEST_F(ReachTest, StretchesTowardsATargetOutOfReach) {
  ReachFor({5, 0, 0});
  const Vec3 leg = poses_.at(0, 11) - poses_.at(0, 9);
  EXPECT_LT(LargestLengthChange(poses_, before_), 1e-6f);
  EXPECT_NEAR(Norm(leg), 0.84f, 0.005f);
  EXPECT_GT(leg.x, 0.5f);
}

TEST_F(ReachTest, AStraightLegBendsForwards) {
  // Hip, knee and foot in line.
  poses_.at(0, 10) = poses_.at(0, 9) + Vec3{0, -0.43f, 0};
  poses_.at(0, 11) = poses_.at(0, 9) + Vec3{0, -0.84f, 0};
  ReachFor(poses_.at(0, 11) + Vec3{0, 0.2f, 0});
  EXPECT_GT(poses_.at(0, 10).z, poses_.at(0, 9).z + 0.1f);
}

TEST(Facing, IsTheDirectionOfTheHips) {
  const Vec3 facing = Facing(*motion::SbuSkeleton().hips, test::Puppet({}, 1)[0]);
  EXPECT_NEAR(facing.z, 1, 1e-5f);
}

}  // namespace
}  // namespace duet::body
