#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/evaluation/experiments/dance.h"
#include "tests/support/sample_motion.h"

namespace duet::evaluation::experiments {
namespace {

constexpr double kDanceRate = 10;

// Twelve seconds; a turn from 4.5 to 6 s, and from 6 to 7 s beside class 0.
dataset::Sequence Take() {
  dataset::Sequence take;
  take.pair.leader = {motion::SbuSkeleton().joint_names, kDanceRate,
                      duet::test::SwayingMotion(120, kDanceRate)};
  take.labels = {{0, 0, 45}, {1, 45, 60}, {1, 60, 70}, {0, 60, 120}};
  return take;
}

std::vector<float> At(const engine::LabelTrack& labels, int frame) {
  std::vector<float> weights(2);
  labels.At(frame, weights.data());
  return weights;
}

TEST(TurnStretches, AreTheTurnsAndStretchesOfFourSecondsWithoutOne) {
  const TurnStretches stretches = FindTurnStretches(Take(), 1, kDanceRate);
  ASSERT_EQ(stretches.led.size(), 1u);
  EXPECT_EQ(stretches.led[0].begin, 45);
  EXPECT_EQ(stretches.led[0].end, 70);
  ASSERT_EQ(stretches.not_led.size(), 2u);
  EXPECT_EQ(stretches.not_led[0].begin, 0);
  EXPECT_EQ(stretches.not_led[0].end, 40);
  EXPECT_EQ(stretches.not_led[1].begin, 70);
  EXPECT_EQ(stretches.not_led[1].end, 110);
}

TEST(LabelsWithTurn, HaveOnlyTheTurnInTheStretches) {
  const engine::LabelTrack labels = LabelsWithTurn(Take(), 2, 1, {{50, 65}}, -0.5);
  EXPECT_THAT(At(labels, 49), testing::ElementsAre(0, 1));
  EXPECT_THAT(At(labels, 50), testing::ElementsAre(0, -0.5f));
  EXPECT_THAT(At(labels, 64), testing::ElementsAre(0, -0.5f));
  EXPECT_THAT(At(labels, 65), testing::ElementsAre(1, 1));
}

TEST(CountTurned, CountsStretchesWithTheMiddleOfATurn) {
  const std::vector<FrameSpan> stretches = {{0, 40}, {70, 110}};
  EXPECT_EQ(CountTurned(stretches, {}, kDanceRate), 0);
  EXPECT_EQ(CountTurned(stretches, {{1, 2, 360}, {2.5, 3.5, -360}}, kDanceRate), 1);
  EXPECT_EQ(CountTurned(stretches, {{3.5, 4.5, 360}, {6, 8.2, 360}}, kDanceRate), 1);
}

}  // namespace
}  // namespace duet::evaluation::experiments
