#include "model/evaluation/experiments/plausibility.h"

#include <algorithm>
#include <cmath>

#include "gtest/gtest.h"
#include "model/authoring/made_leaders.h"

namespace duet::evaluation::experiments {
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

PairFigures Measured(const motion::Poses& leader, const motion::Poses& follower,
                     const ClassContacts& contacts = {}) {
  return Plausibility(motion::SbuSkeleton()).Measure(leader, follower, kRate, contacts);
}

double Figure(const PairFigures& figures, const std::string& name) {
  const std::vector<PairFigure> all = Plausibility::Figures();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const PairFigure& figure) { return figure.name == name; });
  EXPECT_NE(found, all.end()) << name;
  return figures.values[static_cast<size_t>(found - all.begin())];
}

double Figure(const motion::Poses& leader, const motion::Poses& follower, const std::string& name) {
  return Figure(Measured(leader, follower), name);
}

TEST(PlausibilityTest, AStandingPairHasNoFaults) {
  const PairFigures figures = Measured(Person(), Partner(1.2f));
  EXPECT_EQ(figures.values.size(), Plausibility::Figures().size());
  for (const char* name : {"twisted clips", "both feet", "heads", "trunks", "turns"}) {
    EXPECT_EQ(Figure(figures, name), 0) << name;
  }
  EXPECT_NEAR(Figure(figures, "distance"), 1.2, 0.1);
  EXPECT_TRUE(std::isnan(Figure(figures, "hands")));
  for (const double fault : figures.faults) EXPECT_EQ(fault, 0);
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
  EXPECT_GT(Measured(leader, Partner(1.4f), {true}).faults[9], 0.9);
  EXPECT_EQ(Measured(leader, Partner(1.4f), {false}).faults[9], 0);
}

TEST(PlausibilityTest, AJointThatSnapsIsFoundInItsFrame) {
  motion::Poses follower = Partner(1.2f);
  for (int t = 30; t < follower.frame_count(); ++t) {
    follower.at(t, kLeftHand) = follower.at(t, kLeftElbow) * 2 - follower.at(t, kLeftHand);
  }
  const PairFigures figures = Measured(Person(), follower);
  EXPECT_EQ(Figure(figures, "turns"), 1);
  EXPECT_GT(figures.faults[30], 4.9);
  EXPECT_EQ(figures.faults[28], 0);
}

TEST(PlausibilityTest, CombinesMeansAndLargest) {
  PairFigures a, b;
  a.values.assign(Plausibility::Figures().size(), 1);
  b.values.assign(Plausibility::Figures().size(), 4);
  const PairFigures combined{Combine({a, b}), {}};
  EXPECT_EQ(Figure(combined, "speed"), 2.5);
  EXPECT_EQ(Figure(combined, "hips off"), 4);
}

TEST(FindWorstPartTest, FindsThePartWithTheMostFaults) {
  const WorstPart worst = FindWorstPart({0, 1, 0, 0, 2, 2, 0}, 3);
  EXPECT_EQ(worst.first, 3);
  EXPECT_EQ(worst.faults, 4);
  EXPECT_EQ(FindWorstPart({1, 1}, 5).first, 0);
  EXPECT_EQ(FindWorstPart({1, 1}, 5).faults, 2);
}

}  // namespace
}  // namespace duet::evaluation::experiments
