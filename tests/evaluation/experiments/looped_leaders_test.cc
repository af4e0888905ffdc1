#include "model/evaluation/experiments/looped_leaders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/authoring/made_leaders.h"
#include "model/body/liveliness.h"
#include "model/body/motion_quality.h"
#include "model/body/posture.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/sample_motion.h"

namespace duet::evaluation::experiments {
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
  for (const std::string name : authoring::kMadeLeaders) {
    const motion::Poses leader = authoring::MakeLeader(name, 30, kLeaderRate);
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
  for (const std::string name : authoring::kMadeLeaders) {
    const motion::Poses leader = authoring::MakeLeader(name, 10, 60);
    // Of a step, the instants of lifting and setting down are within 5 cm of the floor as well.
    EXPECT_LT(body::MeasureFootSlide(leader, motion::SbuSkeleton(), 60).skating_ratio, 0.15)
        << name;
  }
}

TEST(MadeLeadersTest, MoveAsTheirNamesSay) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const auto made = [](const char* name) { return authoring::MakeLeader(name, 14, kLeaderRate); };
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

TEST(LoopTakeTest, NeedsMoreThanTheTwoFades) {
  dataset::Sequence take;
  take.pair.leader = {motion::SbuSkeleton().joint_names, kLeaderRate,
                      duet::test::SwayingMotion(15, kLeaderRate)};
  EXPECT_FALSE(IsLoopable(take));
  take.pair.leader.poses = duet::test::SwayingMotion(16, kLeaderRate);
  EXPECT_TRUE(IsLoopable(take));
}

TEST(LoopTakeTest, RepeatsTheLabelsWithTheLeader) {
  dataset::Dataset dataset = duet::test::MadeUpPairs(1);
  dataset.frame_rate_hz = kLeaderRate;
  dataset::Sequence take;
  take.pair.leader = {dataset.skeleton.joint_names, kLeaderRate,
                      duet::test::SwayingMotion(60, kLeaderRate)};
  take.pair.follower = take.pair.leader;
  take.labels = {{1, 0, 20}, {2, 30, 60}};
  ASSERT_TRUE(IsLoopable(take));
  const dataset::Sequence looped = LoopTake(dataset, take, 8);
  EXPECT_EQ(looped.pair.leader.frame_count(), 121);
  EXPECT_EQ(looped.pair.follower.frame_count(), 1);
  // The last half second (8 frames) of the take is faded into its next beginning.
  ASSERT_EQ(LoopFrames(dataset, take), 52);
  ASSERT_EQ(looped.labels.size(), 5u);
  const int begins[] = {0, 30, 52, 82, 104}, ends[] = {20, 52, 72, 104, 121};
  for (size_t i = 0; i < looped.labels.size(); ++i) {
    EXPECT_EQ(looped.labels[i].interaction_class, i % 2 == 0 ? 1 : 2) << i;
    EXPECT_EQ(looped.labels[i].begin, begins[i]) << i;
    EXPECT_EQ(looped.labels[i].end, ends[i]) << i;
  }
}

TEST(LoopClipsTest, JoinsClipsWithoutAJump) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const motion::Poses clip = test::SwayingMotion(40, kLeaderRate);
  motion::Poses elsewhere = clip;
  for (motion::Vec3& p : elsewhere.all()) p = RotateY(p, 2) + motion::Vec3{5, 0, -3};
  const motion::Poses looped = LoopClips(skeleton, {clip, elsewhere}, 20, kLeaderRate);
  ASSERT_EQ(looped.frame_count(), 301);
  EXPECT_LT(LargestStep(looped), 3 * LargestStep(clip));
  // Every clip begins where the first one does.
  const int next = 40 - 8;
  float farthest = 0;
  for (int t = 0; t < looped.frame_count(); ++t) {
    farthest = std::max(farthest, Distance(looped.at(t, skeleton.root), clip.at(0, skeleton.root)));
  }
  EXPECT_LT(farthest, 0.6f);
  EXPECT_NEAR(Distance(looped.at(next + 20, skeleton.root), clip.at(20, skeleton.root)), 0, 1e-3);
}

}  // namespace
}  // namespace duet::evaluation::experiments
