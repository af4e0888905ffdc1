#include "model/engine/leader_features.h"

#include <cmath>
#include <map>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/engine/leader_motion.h"
#include "tests/support/test_motion.h"

namespace duet::engine {
namespace {

using ::testing::ElementsAre;

constexpr double kFeatureRate = 15;

std::map<std::string, double> Measure(const motion::Poses& leader,
                                      const motion::Skeleton& skeleton = PlainSkeleton(),
                                      double frame_rate_hz = kFeatureRate) {
  const std::vector<LeaderFeature> features = LeaderFeatures(skeleton);
  const std::vector<double> values = MeasureLeader(skeleton, leader, frame_rate_hz);
  EXPECT_EQ(features.size(), values.size());
  std::map<std::string, double> named;
  for (std::size_t i = 0; i < values.size(); ++i) named[std::string(features[i].name)] = values[i];
  return named;
}

std::vector<std::string> Names(const motion::Skeleton& skeleton) {
  std::vector<std::string> names;
  for (const LeaderFeature& feature : LeaderFeatures(skeleton)) names.emplace_back(feature.name);
  return names;
}

TEST(LeaderFeatures, SomebodyWhoStands) {
  const auto standing = Measure(Standing(20));
  EXPECT_EQ(standing.at("mean_joint_speed"), 0);
  EXPECT_EQ(standing.at("highest_joint_speed"), 0);
  EXPECT_EQ(standing.at("root_path_speed"), 0);
  EXPECT_EQ(standing.at("root_travel"), 0);
  EXPECT_EQ(standing.at("turn"), 0);
  EXPECT_EQ(standing.at("still_share"), 1);
  EXPECT_NEAR(standing.at("bone_length"), (0.5 + 0.2 + 0.2 + 1 + 1 + 0.3 + 0.5) / 7, 1e-6);
  EXPECT_NEAR(standing.at("root_height"), 1 / 1.2, 1e-6);
  EXPECT_NEAR(standing.at("trunk_lean"), 0, 1e-6);
  EXPECT_NEAR(standing.at("hand_reach"), 0.5, 1e-6);
}

TEST(LeaderFeatures, SomebodyWhoWalks) {
  const auto walking = Measure(Walking(31, 1 / kFeatureRate));
  EXPECT_NEAR(walking.at("mean_joint_speed"), 1, 1e-4);
  EXPECT_NEAR(walking.at("highest_joint_speed"), 1, 1e-4);
  EXPECT_NEAR(walking.at("root_path_speed"), 1, 1e-4);
  EXPECT_NEAR(walking.at("root_travel"), 2, 1e-4);
  EXPECT_EQ(walking.at("still_share"), 0);
  EXPECT_NEAR(walking.at("turn"), 0, 1e-3);
}

TEST(LeaderFeatures, TravelIsTheFarthestPointAndThePathTheWholeWay) {
  motion::Poses there_and_back = Walking(61, 1 / kFeatureRate);
  for (int t = 31; t < 61; ++t) {
    for (motion::Vec3& joint : there_and_back[t])
      joint.x -= static_cast<float>(2 * (t - 30) / kFeatureRate);
  }
  const auto walking = Measure(there_and_back);
  EXPECT_NEAR(walking.at("root_travel"), 2, 0.1);
  EXPECT_NEAR(walking.at("root_path_speed"), 1, 0.1);
}

TEST(LeaderFeatures, ClimbingIsNoPathAlongTheFloor) {
  motion::Poses rising = Standing(31);
  for (int t = 0; t < 31; ++t) {
    for (motion::Vec3& joint : rising[t]) joint.y += static_cast<float>(t / kFeatureRate);
  }
  EXPECT_EQ(Measure(rising).at("root_path_speed"), 0);
  EXPECT_EQ(Measure(rising).at("root_travel"), 0);
  EXPECT_NEAR(Measure(rising).at("mean_joint_speed"), 1, 1e-4);
}

TEST(LeaderFeatures, OneFastHand) {
  motion::Poses waving = Standing(31);
  for (int t = 0; t < 31; ++t) waving.at(t, 7).z += static_cast<float>(2 * t / kFeatureRate);
  const auto fast = Measure(waving);
  EXPECT_NEAR(fast.at("highest_joint_speed"), 2, 1e-3);
  EXPECT_NEAR(fast.at("mean_joint_speed"), 2.0 / 8, 1e-3);
  EXPECT_EQ(fast.at("root_path_speed"), 0);
}

TEST(LeaderFeatures, TurningIsTheFarthestFromTheFirstDirection) {
  motion::Poses turning = Standing(61);
  for (int t = 0; t < 61; ++t) {
    const double angle = M_PI / 2 * (t < 30 ? t : 60 - t) / 30;
    for (motion::Vec3& joint : turning[t]) joint = RotateY(joint, angle);
  }
  EXPECT_NEAR(Measure(turning).at("turn"), 90, 8);
}

TEST(LeaderFeatures, SomebodyWhoCrouchesAndLeans) {
  motion::Poses low = Standing(20);
  for (int t = 0; t < 20; ++t) {
    low.at(t, 4).y = 0.5f;  // the higher foot: as if it were kicking
    for (const int foot : {4, 5}) low.at(t, foot).y += 0.25f;
    low.at(t, 1) = {0.5f, 1.5f, 0};
  }
  const double legs = (0.2 + 0.25 + 0.2 + 0.75) / 2;
  EXPECT_NEAR(Measure(low).at("root_height"), 0.75 / legs, 1e-5);
  EXPECT_NEAR(Measure(low).at("trunk_lean"), 45, 1e-3);
}

TEST(LeaderFeatures, MeasuringNoiseIsNoMotion) {
  motion::Poses shaking = Standing(60);
  for (int t = 0; t < 60; t += 2) {
    for (motion::Vec3& joint : shaking[t]) joint.x += 0.02f;  // 0.6 m/s from frame to frame
  }
  const auto still = Measure(shaking, PlainSkeleton(), 30);
  EXPECT_LT(still.at("mean_joint_speed"), 0.02);
  EXPECT_EQ(still.at("still_share"), 1);
}

TEST(LeaderFeatures, PlaceAndDirectionDoNotCount) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  test::PersonOptions elsewhere;
  elsewhere.at = {3, 1.1f, -2};
  elsewhere.yaw = 2;
  const auto here = Measure(test::MakePerson().poses, skeleton);
  const auto there = Measure(test::MakePerson(elsewhere).poses, skeleton);
  for (const auto& [name, value] : here) EXPECT_NEAR(there.at(name), value, 1e-2) << name;
}

TEST(LeaderFeatures, AMirroredLeaderIsTheSame) {
  motion::Poses leader = Standing(20), mirrored = leader;
  const int counterpart[] = {0, 1, 3, 2, 5, 4, 7, 6};
  for (int t = 0; t < 20; ++t) {
    leader.at(t, 4).y = 0.1f;
    for (int j = 0; j < 8; ++j) {
      mirrored.at(t, j) = leader.at(t, counterpart[j]);
      mirrored.at(t, j).x *= -1;
    }
  }
  const auto other = Measure(mirrored);
  for (const auto& [name, value] : Measure(leader))
    EXPECT_NEAR(other.at(name), value, 1e-5) << name;
}

TEST(LeaderFeatures, SingleFrameStandsStill) {
  const auto one = Measure(Standing(1));
  EXPECT_EQ(one.at("mean_joint_speed"), 0);
  EXPECT_EQ(one.at("root_path_speed"), 0);
  EXPECT_EQ(one.at("still_share"), 1);
}

TEST(LeaderFeatures, WhatASkeletonDoesNotGiveIsLeftOut) {
  motion::Skeleton skeleton = PlainSkeleton();
  EXPECT_THAT(
      Names(skeleton),
      ElementsAre("mean_joint_speed", "highest_joint_speed", "root_path_speed", "root_travel",
                  "still_share", "bone_length", "root_height", "turn", "trunk_lean", "hand_reach"));
  skeleton.joint_names[1] = "head";
  skeleton.joint_names[6] = "left_claw";
  EXPECT_THAT(Names(skeleton),
              ElementsAre("mean_joint_speed", "highest_joint_speed", "root_path_speed",
                          "root_travel", "still_share", "bone_length", "root_height", "turn"));
  skeleton.hips.reset();
  skeleton.feet.reset();
  EXPECT_THAT(Names(skeleton),
              ElementsAre("mean_joint_speed", "highest_joint_speed", "root_path_speed",
                          "root_travel", "still_share", "bone_length"));
  EXPECT_EQ(Measure(Standing(5), skeleton).size(), 6u);
}

}  // namespace
}  // namespace duet::engine
