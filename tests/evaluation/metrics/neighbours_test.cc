#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/evaluation/metrics/judged_scores.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::metrics {
namespace {

TEST(NeighbourAccuracyTest, CountsSamplesWhoseNearestIsOfTheirClass) {
  // 0 and 1 are each other's nearest, 5 is nearest to 1, and 9 to 5.
  const FeatureSet line = {{0}, {1}, {5}, {9}};
  EXPECT_EQ(*NeighbourAccuracy(line, {0, 0, 1, 1}, 1), 0.75);
  EXPECT_EQ(*NeighbourAccuracy(line, {0, 0, 0, 0}, 1), 1.0);
  EXPECT_EQ(*NeighbourAccuracy(line, {0, 1, 0, 1}, 1), 0.0);
}

TEST(NeighbourAccuracyTest, TakesTheMajorityOfSeveral) {
  // Every sample of the first three has one of its own class nearest, yet two of class 1 around it.
  const FeatureSet line = {{0}, {0.1f}, {0.3f}, {0.4f}, {0.5f}};
  const std::vector<int> classes = {0, 0, 1, 1, 1};
  EXPECT_EQ(*NeighbourAccuracy(line, classes, 1), 1.0);
  EXPECT_EQ(*NeighbourAccuracy(line, classes, 3), 0.6);
}

TEST(NeighbourAccuracyTest, TiesGoToTheNearestSample) {
  const FeatureSet line = {{0}, {1}, {2.5f}};
  EXPECT_DOUBLE_EQ(*NeighbourAccuracy(line, {0, 0, 1}, 2), 2.0 / 3);
  EXPECT_DOUBLE_EQ(*NeighbourAccuracy(line, {1, 1, 0}, 2), 2.0 / 3);
}

TEST(NeighbourAccuracyTest, MeasuresInAllDimensions) {
  const FeatureSet plane = {{0, 0}, {0, 1}, {3, 0}, {3, 1}};
  EXPECT_EQ(*NeighbourAccuracy(plane, {0, 0, 1, 1}, 1), 1.0);
  EXPECT_EQ(*NeighbourAccuracy(plane, {0, 1, 0, 1}, 1), 0.0);
}

TEST(NeighbourAccuracyTest, TooFewSamplesAreRejected) {
  EXPECT_THAT(NeighbourAccuracy({{0}, {1}}, {0, 1}, 2),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("expected at least 3 vectors, got 2")));
}

}  // namespace
}  // namespace duet::evaluation::metrics
