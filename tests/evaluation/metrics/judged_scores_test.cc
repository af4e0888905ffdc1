#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <random>

#include "model/evaluation/metrics/scores.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::metrics {
namespace {

using ::testing::NanSensitiveDoubleEq;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

FeatureSet RandomSet(int samples, int width, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  FeatureSet set(static_cast<size_t>(samples), std::vector<float>(static_cast<size_t>(width)));
  for (auto& row : set) {
    for (size_t i = 0; i < row.size(); ++i) row[i] = normal(random) * static_cast<float>(i + 1);
  }
  return set;
}

Eigen::MatrixXd Centred(const FeatureSet& set, Eigen::RowVectorXd* mean) {
  Eigen::MatrixXd rows(set.size(), set[0].size());
  for (size_t i = 0; i < set.size(); ++i) {
    for (size_t j = 0; j < set[i].size(); ++j) {
      rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = set[i][j];
    }
  }
  *mean = rows.colwise().mean();
  rows.rowwise() -= *mean;
  return rows / std::sqrt(static_cast<double>(set.size() - 1));
}

Eigen::MatrixXd SymmetricRoot(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
         solver.eigenvectors().transpose();
}

// The textbook form, by eigen-decomposition: Tr (S1^(1/2) S2 S1^(1/2))^(1/2).
double TextbookFrechet(const FeatureSet& a, const FeatureSet& b) {
  Eigen::RowVectorXd mean_a, mean_b;
  const Eigen::MatrixXd rows_a = Centred(a, &mean_a), rows_b = Centred(b, &mean_b);
  const Eigen::MatrixXd sa = rows_a.transpose() * rows_a, sb = rows_b.transpose() * rows_b;
  const Eigen::MatrixXd root = SymmetricRoot(sa);
  return (mean_a - mean_b).squaredNorm() + sa.trace() + sb.trace() -
         2 * SymmetricRoot(root * sb * root).trace();
}

TEST(FrechetDistanceTest, EqualsTheTextbookForm) {
  const FeatureSet a = RandomSet(40, 6, 1), b = RandomSet(30, 6, 2);
  EXPECT_NEAR(FrechetDistance(a, b), TextbookFrechet(a, b), 1e-8);
  EXPECT_NEAR(FrechetDistance(a, b), FrechetDistance(b, a), 1e-9);
}

TEST(FrechetDistanceTest, FewerSamplesThanFeaturesIsExact) {
  const FeatureSet a = RandomSet(5, 40, 3), b = RandomSet(7, 40, 4);
  EXPECT_NEAR(FrechetDistance(a, b), TextbookFrechet(a, b), 1e-3);
  EXPECT_NEAR(FrechetDistance(a, a), 0, 1e-6);
  // Many against few: one factor is reduced, the other is not.
  const FeatureSet many = RandomSet(60, 40, 5);
  EXPECT_NEAR(FrechetDistance(many, a), TextbookFrechet(many, a), 1e-3);
  // Without spread, sets differ by their means.
  EXPECT_NEAR(FrechetDistance(FeatureSet(3, {1, 2, 2}), FeatureSet(4, {0, 0, 0})), 9, 1e-9);
}

TEST(NeighbourAccuracyTest, CountsSamplesWhoseNearestIsOfTheirClass) {
  // 0 and 1 are each other's nearest, 5 is nearest to 1, and 9 to 5.
  const FeatureSet line = {{0, 3}, {1, 3}, {5, 3}, {9, 3}};
  EXPECT_EQ(NeighbourAccuracy(line, {0, 0, 1, 1}), 0.75);
  EXPECT_EQ(NeighbourAccuracy(line, {0, 1, 0, 1}), 0.0);
  EXPECT_TRUE(std::isnan(NeighbourAccuracy({{0}}, {0})));
}

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

TEST(FrechetByClass, AveragesTheFoldsThatHaveTwoMotionsOnBothSides) {
  // Sets that differ by a shift alone: the squared shift.
  const JudgedFold one = {{0}, {{1, 0}}, {{5, 5}}};
  const auto distances =
      FrechetByClass({Fold(3, 1), Fold(1, 2), Fold(3, 1)}, {Fold(0, 1), Fold(0, 2), one}, 2);
  EXPECT_THAT(distances,
              ElementsAre(DoubleNear((9.0 + 1.0) / 2, 1e-6), NanSensitiveDoubleEq(kNone)));
}

TEST(DiversityByClass, NeverComparesAcrossFolds) {
  EXPECT_DOUBLE_EQ(Diversity({{0, 0}, {3, 4}, {0, 4}}), (5 + 4 + 3) / 3.0);
  EXPECT_EQ(Diversity({{1, 1}}), 0);
  EXPECT_THAT(DiversityByClass({Fold(0, 1), Fold(1000, 3)}, 2),
              ElementsAre(DoubleNear(2, 1e-6), NanSensitiveDoubleEq(kNone)));
}

}  // namespace
}  // namespace duet::evaluation::metrics
