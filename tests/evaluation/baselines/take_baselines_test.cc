#include <gtest/gtest.h>

#include <cmath>

#include "model/evaluation/baselines/other_people.h"
#include "model/motion/standardise.h"
#include "tests/support/sample_motion.h"

namespace duet::evaluation::baselines {
namespace {

constexpr double kTakeRate = 10;
constexpr int kFrames = 40;

// The follower stands as far in front of the leader as the leader's rhythm tells.
dataset::Sequence Take(double rhythm, int interaction_class) {
  dataset::Sequence take;
  take.interaction_class = interaction_class;
  motion::Poses leader(0, 15), follower(0, 15);
  for (int t = 0; t < kFrames; ++t) {
    std::vector<motion::Vec3> pose = test::SwayingPose(rhythm * t / kTakeRate);
    leader.Append(pose);
    for (motion::Vec3& p : pose) p = p + motion::Vec3{0, 0, static_cast<float>(-rhythm)};
    follower.Append(pose);
  }
  take.pair.leader.poses = leader;
  take.pair.follower.poses = follower;
  return take;
}

dataset::Dataset Takes() {
  dataset::Dataset takes;
  takes.skeleton = motion::SbuSkeleton();
  takes.classes = {"slow", "fast"};
  takes.frame_rate_hz = kTakeRate;
  takes.sequences = {Take(1, 0), Take(2, 1)};
  return takes;
}

dataset::Sequence Moved(dataset::Sequence take) {
  for (motion::Clip* clip : {&take.pair.leader, &take.pair.follower}) {
    for (motion::Vec3& p : clip->poses.all()) p = RotateY(p, 0.7) + motion::Vec3{3, 0, 1};
  }
  return take;
}

double Farthest(const motion::Poses& a, const motion::Poses& b) {
  EXPECT_EQ(a.frame_count(), b.frame_count());
  double farthest = 0;
  for (std::size_t i = 0; i < a.all().size(); ++i) {
    farthest = std::max<double>(farthest, Distance(a.all()[i], b.all()[i]));
  }
  return farthest;
}

TEST(TakeBaselinesTest, NearestSecondsFindAKnownTakeElsewhereInTheWorld) {
  const dataset::Dataset takes = Takes();
  const dataset::Sequence take = Moved(takes.sequences[1]);
  // Training seconds begin every tenth of a second, here at every frame.
  const motion::Poses follower = NearestSeconds(takes, {0, 1}, take);
  ASSERT_EQ(follower.frame_count(), kFrames);
  EXPECT_LT(Farthest(follower, take.pair.follower.poses), 1e-4);
}

TEST(TakeBaselinesTest, NearestSecondsLearnFromTrainingSequencesOnly) {
  const dataset::Dataset takes = Takes();
  const motion::Poses follower = NearestSeconds(takes, {0}, takes.sequences[1]);
  EXPECT_GT(Farthest(follower, takes.sequences[1].pair.follower.poses), 0.5);
}

TEST(TakeBaselinesTest, MeanOfClassDependsOnTheTimeLine) {
  const dataset::Dataset takes = Takes();
  dataset::Sequence take = Moved(takes.sequences[0]);
  take.labels = {{0, 0, 20}, {1, 20, kFrames}};
  const motion::Poses follower = MeanOfClass(takes, {0, 1}, take);
  const int root = takes.skeleton.root;
  const auto distance = [&](int t) {
    return Distance(follower.at(t, root), take.pair.leader.at(t, root));
  };
  EXPECT_NEAR(distance(10), 1, 0.3);
  EXPECT_NEAR(distance(30), 2, 0.3);
}

TEST(TakeBaselinesTest, FirstPoseIsHeld) {
  const dataset::Sequence take = Takes().sequences[0];
  const motion::Poses held = FirstPoseHeld(take);
  ASSERT_EQ(held.frame_count(), kFrames);
  EXPECT_EQ(held.at(kFrames - 1, 3), take.pair.follower.at(0, 3));
}

}  // namespace
}  // namespace duet::evaluation::baselines
