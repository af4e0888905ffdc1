#include <algorithm>
#include <cmath>

#include "gtest/gtest.h"
#include "model/authoring/made_leaders.h"
#include "model/evaluation/program/experiment.h"

namespace duet::evaluation::program {
namespace {

using motion::Vec3;

constexpr double kRate = 15;
constexpr int kLeftElbow = 4, kLeftHand = 5, kRightHand = 8;

// Stands and sways, and faces -z.
motion::Poses Person() { return authoring::MakeLeader("idle", 4, kRate); }

// The same, `metres` in front of it, facing back.
motion::Poses Partner(float metres) {
  motion::Poses poses = Person();
  for (Vec3& joint : poses.all()) joint = {-joint.x, joint.y, -metres - joint.z};
  return poses;
}

// The person with a stretched limb whose end is so far in front of the root, at a height.
motion::Poses ReachingOut(int joint, float ahead, float height) {
  motion::Poses poses = Person();
  for (int t = 0; t < poses.frame_count(); ++t) {
    poses.at(t, joint) = {poses.at(t, 2).x, height, poses.at(t, 2).z - ahead};
    poses.at(t, joint - 1) = Lerp(poses.at(t, joint - 2), poses.at(t, joint), 0.5f);
  }
  return poses;
}

double Figure(const motion::Poses& leader, const motion::Poses& follower, const std::string& name) {
  const std::vector<std::string>& all = PlausibleFigures();
  const std::vector<double> figures =
      MeasurePlausibility(motion::SbuSkeleton(), leader, follower, kRate);
  EXPECT_EQ(figures.size(), all.size());
  const auto found = std::find(all.begin(), all.end(), name);
  EXPECT_NE(found, all.end()) << name;
  return figures[static_cast<size_t>(found - all.begin())];
}

TEST(PlausibilityTest, AStandingPairHasNoFaults) {
  const motion::Poses follower = Partner(1.2f);
  for (const char* name : {"twisted clips", "both feet", "heads", "trunks", "turns"}) {
    EXPECT_EQ(Figure(Person(), follower, name), 0) << name;
  }
  EXPECT_NEAR(Figure(Person(), follower, "distance"), 1.2, 0.1);
  EXPECT_TRUE(std::isnan(Figure(Person(), follower, "hands")));
}

TEST(PlausibilityTest, AnEmbraceHasBothHandsBehindTheLeader) {
  const motion::Poses leader = Person();
  motion::Poses follower = Partner(0.4f);
  constexpr int kRoot = 2, kHands[] = {5, 8};
  for (const int hand : kHands) {
    EXPECT_EQ(Figure(leader, follower, "embrace"), 0);
    for (int t = 0; t < follower.frame_count(); ++t) {
      follower.at(t, hand) = leader.at(t, kRoot) + motion::Vec3{0, 0.1f, 0.15f};
    }
  }
  EXPECT_EQ(Figure(leader, follower, "embrace"), 1);
}

TEST(PlausibilityTest, AFollowerWhoTurnsAway) {
  motion::Poses follower = Partner(1.2f);
  EXPECT_LT(Figure(Person(), follower, "facing"), 20);
  // Half of the frames, farther away and with the back to the leader.
  const int frames = follower.frame_count();
  const motion::Poses person = Person();
  for (int t = frames / 2; t < frames; ++t) {
    for (int j = 0; j < follower.joint_count(); ++j) {
      follower.at(t, j) = person.at(t, j) + Vec3{0, 0, -3};
    }
  }
  EXPECT_NEAR(Figure(Person(), follower, "facing"), 90, 15);
}

TEST(PlausibilityTest, HandsAreMeasuredWhileOneIsReachedOut) {
  const motion::Poses leader = ReachingOut(kRightHand, 0.7f, 1.1f);
  const double near = Figure(leader, Partner(0.9f), "hands");
  const double far = Figure(leader, Partner(1.4f), "hands");
  EXPECT_GT(near, 0.2);
  EXPECT_GT(far, near + 0.2);
}

TEST(PlausibilityTest, AJointThatSnapsIsFound) {
  motion::Poses follower = Partner(1.2f);
  for (int t = 30; t < follower.frame_count(); ++t) {
    follower.at(t, kLeftHand) = follower.at(t, kLeftElbow) * 2 - follower.at(t, kLeftHand);
  }
  EXPECT_EQ(Figure(Person(), follower, "turns"), 1);
}

}  // namespace
}  // namespace duet::evaluation::program
