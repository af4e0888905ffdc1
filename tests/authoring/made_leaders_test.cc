#include "model/authoring/made_leaders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/body/liveliness.h"
#include "model/body/motion_quality.h"
#include "model/body/posture.h"

namespace duet::authoring {
namespace {

using body::LeanFrom;

constexpr double kLeaderRate = 15;

float LargestStep(const motion::Poses& poses) {
  float largest = 0;
  for (int t = 1; t < poses.frame_count(); ++t) {
    for (int j = 0; j < poses.joint_count(); ++j) {
      largest = std::max(largest, Distance(poses.at(t, j), poses.at(t - 1, j)));
    }
  }
  return largest;
}

TEST(MadeLeadersTest, StandOnTheFloorWithLimbsOfOneLength) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  for (const std::string name : kMadeLeaders) {
    const motion::Poses leader = MakeLeader(name, 30, kLeaderRate);
    ASSERT_EQ(leader.frame_count(), 451) << name;
    EXPECT_LT(body::BoneLengthDrift(leader, skeleton), 1e-3) << name;
    const body::FloorGap gap = body::MeasureFloorGap(leader, skeleton, 0);
    EXPECT_LT(gap.above, 0.02) << name;
    EXPECT_LT(gap.below, 0.02) << name;
    EXPECT_LT(body::MeasureLean(leader, skeleton, kLeaderRate, LeanFrom::kHips).max_degrees, 35)
        << name;
    EXPECT_LT(LargestStep(leader), 0.35f) << name;
  }
}

TEST(MadeLeadersTest, StandingFeetDoNotSlide) {
  for (const std::string name : kMadeLeaders) {
    const motion::Poses leader = MakeLeader(name, 10, 60);
    // Of a step, the instants of lifting and setting down are within 5 cm of the floor as well.
    EXPECT_LT(body::MeasureFootSlide(leader, motion::SbuSkeleton(), 60).skating_ratio, 0.15)
        << name;
  }
}

TEST(MadeLeadersTest, MoveAsTheirNamesSay) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const auto made = [](const char* name) { return MakeLeader(name, 14, kLeaderRate); };
  EXPECT_LT(body::JointSpeed(made("idle"), kLeaderRate), 0.1);
  EXPECT_GT(body::JointSpeed(made("dance"), kLeaderRate), 0.3);
  // An eight: wide, and where it began at the end.
  const motion::Poses walk = made("walk_eight");
  float widest = 0;
  for (int t = 0; t < walk.frame_count(); ++t) {
    widest = std::max(widest, std::abs(walk.at(t, skeleton.root).x));
  }
  EXPECT_NEAR(widest, 1.5, 0.1);
  EXPECT_LT(Distance(walk.at(0, skeleton.root), walk.at(14 * 15, skeleton.root)), 0.1);
  // It looks where it goes: half a second later its root is in front of it.
  for (int t = 0; t + 8 < walk.frame_count(); t += 8) {
    const motion::Vec3 way = walk.at(t + 4, skeleton.root) - walk.at(t, skeleton.root);
    const motion::Vec3 across = walk.at(t, skeleton.hips->right) - walk.at(t, skeleton.hips->left);
    EXPECT_GT(Dot(Cross({0, 1, 0}, across), way), 0) << t;
  }
  const motion::Poses sit = made("sit");
  EXPECT_LT(sit.at(5 * 15, skeleton.root).y, sit.at(0, skeleton.root).y - 0.3f);
}

}  // namespace
}  // namespace duet::authoring
