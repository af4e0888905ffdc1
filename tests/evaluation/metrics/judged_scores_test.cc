#include "model/evaluation/metrics/judged_scores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/matchers.h"

namespace duet::evaluation::metrics {
namespace {

using ::testing::NanSensitiveDoubleEq;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(AccuracyByClass, PoolsTheFolds) {
  // Class 0: right, right, wrong over two folds; class 1: wrong once; class 2: never asked for.
  const JudgedFold first = {{0, 1}, {{0.6f, 0.3f, 0.1f}, {0.5f, 0.2f, 0.3f}}, {{0}, {0}}};
  const JudgedFold second = {{0, 0}, {{0.4f, 0.3f, 0.3f}, {0.1f, 0.1f, 0.8f}}, {{0}, {0}}};
  EXPECT_THAT(AccuracyByClass({first, second}, 3),
              ElementsAre(DoubleNear(2.0 / 3, 1e-12), 0, NanSensitiveDoubleEq(kNone)));
}

// Two motions of class 0 at `at` and `at` + `apart` in a plane of features, and one of class 1.
JudgedFold Fold(float at, float apart) {
  return {{0, 1, 0}, {{1, 0}, {0, 1}, {1, 0}}, {{at, 0}, {9, 9}, {at + apart, 0}}};
}

TEST(FrechetByClass, AveragesTheFoldsThatHaveTwoMotions) {
  // Sets that differ by a shift alone: the squared shift.
  const absl::StatusOr<std::vector<double>> distances =
      FrechetByClass({Fold(3, 1), Fold(1, 2)}, {Fold(0, 1), Fold(0, 2)}, 2);
  ASSERT_TRUE(distances.ok()) << distances.status();
  EXPECT_THAT(*distances,
              ElementsAre(DoubleNear((9.0 + 1.0) / 2, 1e-6), NanSensitiveDoubleEq(kNone)));
}

TEST(FrechetByClass, LeavesOutAFoldWithOneCapturedMotion) {
  const JudgedFold one = {{0}, {{1, 0}}, {{5, 5}}};
  const absl::StatusOr<std::vector<double>> distances =
      FrechetByClass({Fold(3, 1), Fold(2, 1)}, {one, Fold(0, 1)}, 2);
  ASSERT_TRUE(distances.ok()) << distances.status();
  EXPECT_NEAR(distances->front(), 4, 1e-6);
}

TEST(FrechetByClass, RefusesFeaturesThatAreNotFinite) {
  const JudgedFold broken = Fold(std::numeric_limits<float>::infinity(), 1);
  EXPECT_TRUE(absl::IsInvalidArgument(FrechetByClass({broken}, {Fold(0, 1)}, 2).status()));
}

TEST(DiversityByClass, NeverComparesAcrossFolds) {
  EXPECT_THAT(DiversityByClass({Fold(0, 1), Fold(1000, 3)}, 2),
              ElementsAre(DoubleNear(2, 1e-6), NanSensitiveDoubleEq(kNone)));
}

}  // namespace
}  // namespace duet::evaluation::metrics
