#include "model/training/live_leader.h"

#include <gtest/gtest.h>

#include "tests/support/sample_motion.h"

namespace duet::training {
namespace {

constexpr double kRate = 15;
constexpr int kFrames = 40, kKnown = 8, kClasses = 2;

// A swaying pair of which `known` follower frames are told, labels that differ in every frame.
FlowExample Swaying(int known) {
  FlowExample example;
  example.input.leader = test::SwayingMotion(kFrames, kRate);
  example.target = example.input.leader;
  example.input.settled = example.target;
  example.input.settled.Resize(known);
  for (int t = 0; t < kFrames; ++t) {
    example.input.labels.push_back(static_cast<float>(t));
    example.input.labels.push_back(static_cast<float>(-t));
  }
  return example;
}

FlowExample Hidden(const FlowTraining::Live& live, int known, uint64_t seed) {
  base::Random random(seed);
  FlowExample example = Swaying(known);
  HideFuture(motion::SbuSkeleton(), kRate, live, &random, &example);
  return example;
}

// The number of first frames in which two leaders agree.
int CommonFrames(const motion::Poses& a, const motion::Poses& b) {
  int count = 0;
  while (count < a.frame_count() && a[count] == b[count]) ++count;
  return count;
}

FlowTraining::Live ExactlyAtTheLastKnownFrame() {
  FlowTraining::Live live;
  live.remade_seconds = live.delay_seconds = 0;
  live.future_seconds = 1;
  return live;
}

TEST(HideFuture, LeaderIsTrueUntilNowAndComesToRest) {
  const FlowExample captured = Swaying(kKnown);
  const FlowExample example = Hidden(ExactlyAtTheLastKnownFrame(), kKnown, 1);
  const motion::Poses& leader = example.input.leader;
  EXPECT_EQ(leader.frame_count(), kKnown + 15);  // a second of future
  EXPECT_EQ(CommonFrames(leader, captured.input.leader), kKnown);
  EXPECT_EQ(example.input.hidden_frames, 15);
  const int last = leader.frame_count() - 1;
  EXPECT_LT(Distance(leader.at(last, 0), leader.at(last - 1, 0)), 1e-3f);
}

TEST(HideFuture, TargetKeepsItsFramesAndIsNotChanged) {
  const FlowExample captured = Swaying(kKnown);
  const FlowExample example = Hidden(ExactlyAtTheLastKnownFrame(), kKnown, 1);
  EXPECT_EQ(example.target.frame_count(), example.input.leader.frame_count());
  EXPECT_EQ(CommonFrames(example.target, captured.target), example.target.frame_count());
}

TEST(HideFuture, LabelsStayAsTheyAreNow) {
  const FlowExample example = Hidden(ExactlyAtTheLastKnownFrame(), kKnown, 1);
  const std::vector<float>& labels = example.input.labels;
  ASSERT_EQ(labels.size(), static_cast<size_t>(example.target.frame_count() * kClasses));
  for (int t = 0; t < example.target.frame_count(); ++t) {
    EXPECT_EQ(labels[static_cast<size_t>(t * kClasses)], std::min(t, kKnown - 1));
  }
}

TEST(HideFuture, PresentAndDelayAreDrawnUpToTheirMost) {
  FlowTraining::Live live;
  live.remade_seconds = 4 / kRate;
  live.delay_seconds = 3 / kRate;
  const motion::Poses captured = Swaying(kKnown).input.leader;
  int least = kFrames, most = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const int common = CommonFrames(Hidden(live, kKnown, seed).input.leader, captured);
    least = std::min(least, common);
    most = std::max(most, common);
  }
  EXPECT_EQ(least, kKnown);
  EXPECT_EQ(most, kKnown + 4 + 3);
}

TEST(HideFuture, ASessionThatBeginsKnowsTheFirstFrame) {
  const motion::Poses captured = Swaying(0).input.leader;
  const FlowExample example = Hidden(ExactlyAtTheLastKnownFrame(), 0, 1);
  EXPECT_EQ(CommonFrames(example.input.leader, captured), 1);
  EXPECT_EQ(example.input.leader[1], captured[0]);  // a velocity needs two frames
}

}  // namespace
}  // namespace duet::training
