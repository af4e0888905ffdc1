#include "model/engine/leader_statistics.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/engine/clip_synthesis.h"
#include "model/engine/network_synthesizer.h"
#include "tests/engine/rule_network.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/test_motion.h"

namespace duet::engine {
namespace {

using test::FakeDescription;
using ::testing::ElementsAre;

constexpr double kRate = 15;

// A person of eight joints, root first, who stands upright with the right hand stretched forwards:
// root and hips 1 m high, legs of 1.2 m with the hips, the neck 0.5 m above the root.
motion::Skeleton PlainSkeleton() {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"root",      "neck",       "left_hip",  "right_hip",
                          "left_foot", "right_foot", "left_hand", "right_hand"};
  skeleton.bones = {{0, 1}, {0, 2}, {0, 3}, {2, 4}, {3, 5}, {0, 6}, {0, 7}};
  skeleton.hips = motion::JointPair{2, 3};
  skeleton.feet = motion::JointPair{4, 5};
  return skeleton;
}

motion::Poses Standing(int frames) {
  const std::vector<motion::Vec3> pose = {{0, 1, 0},    {0, 1.5f, 0},   {-0.2f, 1, 0},
                                          {0.2f, 1, 0}, {-0.2f, 0, 0},  {0.2f, 0, 0},
                                          {0.3f, 1, 0}, {0.3f, 1, 0.4f}};
  motion::Poses poses(0, 8);
  for (int t = 0; t < frames; ++t) poses.Append(pose);
  return poses;
}

// The same person, gliding along x.
motion::Poses Walking(int frames, double metres_per_frame) {
  motion::Poses poses = Standing(frames);
  for (int t = 0; t < frames; ++t) {
    for (motion::Vec3& joint : poses[t]) joint.x += static_cast<float>(t * metres_per_frame);
  }
  return poses;
}

std::map<std::string, double> Measure(const motion::Poses& leader,
                                      const motion::Skeleton& skeleton = PlainSkeleton(),
                                      double frame_rate_hz = kRate) {
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
  const auto walking = Measure(Walking(31, 1 / kRate));
  EXPECT_NEAR(walking.at("mean_joint_speed"), 1, 1e-4);
  EXPECT_NEAR(walking.at("highest_joint_speed"), 1, 1e-4);
  EXPECT_NEAR(walking.at("root_path_speed"), 1, 1e-4);
  EXPECT_NEAR(walking.at("root_travel"), 2, 1e-4);
  EXPECT_EQ(walking.at("still_share"), 0);
  EXPECT_NEAR(walking.at("turn"), 0, 1e-3);
}

TEST(LeaderFeatures, TravelIsTheFarthestPointAndThePathTheWholeWay) {
  motion::Poses there_and_back = Walking(61, 1 / kRate);
  for (int t = 31; t < 61; ++t) {
    for (motion::Vec3& joint : there_and_back[t])
      joint.x -= static_cast<float>(2 * (t - 30) / kRate);
  }
  const auto walking = Measure(there_and_back);
  EXPECT_NEAR(walking.at("root_travel"), 2, 0.1);
  EXPECT_NEAR(walking.at("root_path_speed"), 1, 0.1);
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

constexpr int kStatisticsFrames = 31;

// People who step forwards and stretch a hand, no two alike.
std::vector<motion::Poses> TrainingLeaders(int count) {
  std::vector<motion::Poses> leaders;
  for (int i = 0; i < count; ++i) {
    motion::Poses leader = Walking(kStatisticsFrames, 0.001 * (i % 7));
    for (int t = 0; t < kStatisticsFrames; ++t) {
      leader.at(t, 7).z += 0.002f * static_cast<float>(t * (i % 5) + i);
    }
    leaders.push_back(std::move(leader));
  }
  return leaders;
}

LeaderStatistics FitTo(const std::vector<motion::Poses>& leaders) {
  std::vector<const motion::Poses*> pointers;
  for (const motion::Poses& leader : leaders) pointers.push_back(&leader);
  return FitLeaderStatistics(PlainSkeleton(), pointers, kRate);
}

double Far(const LeaderStatistics& statistics, const motion::Poses& leader) {
  return Unfamiliarity(statistics, PlainSkeleton(), leader, kRate);
}

const LeaderStatistics::Feature& Named(const LeaderStatistics& statistics,
                                       const std::string& name) {
  return *std::find_if(statistics.features.begin(), statistics.features.end(),
                       [&](const auto& feature) { return feature.name == name; });
}

TEST(LeaderStatistics, AreMeanAndSpreadOfTheLeaders) {
  const LeaderStatistics statistics =
      FitTo({Standing(kStatisticsFrames), Walking(kStatisticsFrames, 1 / kRate)});
  EXPECT_NEAR(Named(statistics, "root_path_speed").mean, 0.5, 1e-4);
  EXPECT_NEAR(Named(statistics, "root_path_speed").deviation, 0.5, 1e-4);
  EXPECT_NEAR(Named(statistics, "still_share").mean, 0.5, 1e-4);
  EXPECT_NEAR(Named(statistics, "bone_length").mean, 3.7 / 7, 1e-4);
}

TEST(LeaderStatistics, LeadersWhoAreAllAlikeLeaveRoomAroundThem) {
  for (const int count : {1, 3}) {
    const LeaderStatistics statistics = FitTo(
        std::vector<motion::Poses>(static_cast<std::size_t>(count), Standing(kStatisticsFrames)));
    for (const LeaderFeature& feature : LeaderFeatures(PlainSkeleton())) {
      EXPECT_EQ(Named(statistics, std::string(feature.name)).deviation, feature.smallest_deviation);
    }
    EXPECT_EQ(statistics.scale, 0.5);
    EXPECT_NEAR(Far(statistics, Standing(kStatisticsFrames)), 0, 1e-6);
  }
}

TEST(LeaderStatistics, ATenthOfTheTrainingLeadersIsFartherThanOne) {
  const std::vector<motion::Poses> leaders = TrainingLeaders(40);
  const LeaderStatistics statistics = FitTo(leaders);
  std::vector<double> far;
  for (const motion::Poses& leader : leaders) far.push_back(Far(statistics, leader));
  std::sort(far.begin(), far.end());
  EXPECT_NEAR(far[35], 1, 1e-9);
  EXPECT_GT(far[36], 1);
  EXPECT_LT(far.front(), 0.8);
}

TEST(LeaderStatistics, RootMeanSquareOfTheFeaturesThatAreKnownByTheScale) {
  LeaderStatistics statistics;
  statistics.features = {{"root_path_speed", 0.5, 0.25}};
  EXPECT_NEAR(Far(statistics, Walking(kStatisticsFrames, 1 / kRate)), 2, 1e-3);
  statistics.scale = 4;
  EXPECT_NEAR(Far(statistics, Walking(kStatisticsFrames, 1 / kRate)), 0.5, 1e-3);
  statistics.features.push_back({"still_share", 1, 0.5});  // 2 deviations as well
  EXPECT_NEAR(Far(statistics, Walking(kStatisticsFrames, 1 / kRate)), 0.5, 1e-3);
  statistics.features.push_back({"root_travel", 2, 1});  // none
  EXPECT_NEAR(Far(statistics, Walking(kStatisticsFrames, 1 / kRate)), 0.5 * std::sqrt(2.0 / 3),
              1e-3);
}

TEST(LeaderStatistics, NinthDecileIsOneOfTheValues) {
  EXPECT_EQ(NinthDecile({5}), 5);
  EXPECT_EQ(NinthDecile({2, 1}), 2);
  EXPECT_EQ(NinthDecile({10, 9, 8, 7, 6, 5, 4, 3, 2, 1}), 9);
  EXPECT_EQ(NinthDecile({11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1}), 10);
}

constexpr int kWindow = 16;

// Trained on people who stand.
ModelDescription TrainedOnStanding() {
  ModelDescription model = FakeDescription();
  model.skeleton = PlainSkeleton();
  model.frame_rate_hz = kRate;
  model.window_frames = kWindow;
  const motion::Poses standing = Standing(kWindow);
  model.leader_statistics = FitLeaderStatistics(model.skeleton, {&standing}, kRate);
  return model;
}

ClipRequest Request(motion::Poses leader, double frame_rate_hz = kRate) {
  return {std::move(leader), frame_rate_hz, LabelTrack(std::vector<float>(6, 0)),
          std::nullopt,      std::nullopt,  {}};
}

// What a synthesizer of the model reports.
std::optional<double> Reported(const ModelDescription& model, const ClipRequest& request) {
  const auto synthesizer = MakeSynthesizer(
      model, motion::StandardOrigin::kFirstFrame,
      std::make_unique<RuleNetwork>([](Inputs) -> Answer { return absl::InternalError(""); }));
  return synthesizer->Unfamiliarity(request);
}

// Stands, but for `walked` windows of `windows`, in which the leader goes along x at 1 m/s.
motion::Poses WalkingIn(int walked, int windows) {
  const int frames = 1 + windows * (kWindow - 1), steps = walked * (kWindow - 1);
  motion::Poses leader = Standing(frames);
  for (int t = 0; t < frames; ++t) {
    for (motion::Vec3& joint : leader[t]) joint.x += static_cast<float>(std::min(t, steps) / kRate);
  }
  return leader;
}

TEST(Unfamiliarity, IsNotKnownWithoutStatistics) {
  ModelDescription model = TrainedOnStanding();
  model.leader_statistics.reset();
  EXPECT_FALSE(Reported(model, Request(Standing(kWindow))).has_value());
}

TEST(Unfamiliarity, OfOneWindowIsItsLeaders) {
  const ModelDescription model = TrainedOnStanding();
  EXPECT_NEAR(*Reported(model, Request(Standing(kWindow))), 0, 1e-6);
  const motion::Poses walking = Walking(kWindow, 1 / kRate);
  const double far = Unfamiliarity(*model.leader_statistics, model.skeleton, walking, kRate);
  EXPECT_GT(far, 2);
  EXPECT_NEAR(*Reported(model, Request(walking)), far, 1e-6);
}

TEST(Unfamiliarity, IsMeasuredAtTheModelsRate) {
  const ModelDescription model = TrainedOnStanding();
  const double far = *Reported(model, Request(Walking(kWindow, 1 / kRate)));
  EXPECT_NEAR(*Reported(model, Request(Walking(2 * kWindow - 1, 0.5 / kRate), 2 * kRate)), far,
              1e-3);
  // The same frames at twice the rate.
  EXPECT_GT(*Reported(model, Request(Walking(kWindow, 1 / kRate), 2 * kRate)), far * 1.2);
}

TEST(Unfamiliarity, OfALongClipIsThatOfItsFarthestTenth) {
  const ModelDescription model = TrainedOnStanding();
  const double far = *Reported(model, Request(WalkingIn(20, 20)));
  EXPECT_GT(far, 2);
  EXPECT_LT(*Reported(model, Request(WalkingIn(1, 20))), 0.5);
  EXPECT_NEAR(*Reported(model, Request(WalkingIn(4, 20))), far, 0.1 * far);
}

TEST(Unfamiliarity, IsNotKnownWhereNoNumberHoldsIt) {
  motion::Poses leader = Standing(kWindow);
  leader.at(3, 0).x = 3e38f;
  leader.at(4, 0).x = -3e38f;
  EXPECT_FALSE(Reported(TrainedOnStanding(), Request(leader)).has_value());
}

}  // namespace
}  // namespace duet::engine
