#include "model/authoring/made_leaders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/body/liveliness.h"
#include "model/body/motion_quality.h"
#include "model/motion/skeleton.h"

namespace duet::authoring {
namespace {

using motion::Poses;

constexpr double kRate = 30;

// The largest movement of the root in a frame.
float LargestStep(const Poses& poses) {
  const int root = motion::SbuSkeleton().root;
  float largest = 0;
  for (int t = 1; t < poses.frame_count(); ++t) {
    largest = std::max(largest, Distance(poses.at(t, root), poses.at(t - 1, root)));
  }
  return largest;
}

TEST(HourLeadersTest, StayNearTheOriginWithLimbsOfOneLength) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  EXPECT_THAT(kHourLeaders, ::testing::ElementsAre("idle", "wild", "absent", "teleporting"));
  for (const std::string name : kHourLeaders) {
    const Poses leader = MakeLeader(name, 120, kRate);
    ASSERT_EQ(leader.frame_count(), 120 * 30 + 1) << name;
    float farthest = 0;
    for (int t = 0; t < leader.frame_count(); ++t) {
      const motion::Vec3 root = leader.at(t, skeleton.root);
      farthest = std::max(farthest, std::hypot(root.x, root.z));
    }
    EXPECT_LT(farthest, 2.5f) << name;
    // Interpolated frames shorten limbs a little.
    EXPECT_LT(body::BoneLengthDrift(leader, skeleton), name == "absent" ? 0.02 : 1e-3) << name;
  }
}

TEST(HourLeadersTest, MoveAsTheirNamesSay) {
  const auto made = [](const char* name) { return MakeLeader(name, 60, kRate); };
  EXPECT_LT(body::JointSpeed(made("idle"), kRate), 0.1);
  EXPECT_GT(body::JointSpeed(made("wild"), kRate), 2);
  EXPECT_LT(LargestStep(made("wild")), 0.3f) << "fast, but without jumps";
  EXPECT_GT(LargestStep(made("teleporting")), 1);
}

TEST(HourLeadersTest, TheLastMinuteIsLikeTheFirst) {
  for (const std::string name : kHourLeaders) {
    const Poses leader = MakeLeader(name, 600, kRate);
    const auto speed = [&](int first) {
      Poses minute(0, leader.joint_count());
      minute.Append(leader.frames(first, 1800));
      return body::JointSpeed(minute, kRate);
    };
    const double ratio = speed(leader.frame_count() - 1800) / speed(0);
    // An absent leader moves for 3 s of 3.1 to 33.
    if (name == "absent") continue;
    EXPECT_GT(ratio, 0.8) << name;
    EXPECT_LT(ratio, 1.25) << name;
  }
}

TEST(WithGapsTest, ShortGapsAreInterpolatedAndLongOnesHeld) {
  Poses leader(1000, 1);
  for (int t = 0; t < 1000; ++t) {
    leader.at(t, 0) = {static_cast<float>(t) * static_cast<float>(t), 0, 0};
  }
  const Poses sent = WithGaps(leader, kRate);
  const auto x = [&](int t) { return sent.at(t, 0).x; };
  ASSERT_EQ(sent.frame_count(), 1000);
  // Three seconds, then gaps of 3, 6 and 15 frames.
  EXPECT_EQ(x(89), 89 * 89);
  EXPECT_NEAR(x(91), (89 * 89 + 93 * 93) / 2.0, 0.1);
  EXPECT_EQ(x(93), 93 * 93);
  EXPECT_EQ(x(182), 182 * 182);
  EXPECT_GT(x(183), 183 * 183) << "on a straight line";
  EXPECT_EQ(x(189), 189 * 189);
  EXPECT_EQ(x(278), 278 * 278);
  for (int t = 279; t < 294; ++t) EXPECT_EQ(x(t), 278 * 278) << "held";
  EXPECT_EQ(x(294), 294 * 294);
}

TEST(WithGapsTest, AMotionWithoutRoomForAGapIsUnchanged) {
  const Poses leader(92, 2);
  EXPECT_EQ(WithGaps(leader, kRate).frame_count(), 92);
}

}  // namespace
}  // namespace duet::authoring
