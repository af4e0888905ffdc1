#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <random>

#include "model/evaluation/metrics/judged_scores.h"

namespace duet::evaluation::metrics {
namespace {

double Frechet(const FeatureSet& a, const FeatureSet& b) {
  const absl::StatusOr<double> distance = FrechetDistance(a, b);
  EXPECT_TRUE(distance.ok()) << distance.status();
  return distance.value_or(-1);
}

// Four samples with mean (mx, my) and covariance diag(sx^2, sy^2).
FeatureSet Diagonal(float mx, float my, float sx, float sy) {
  const float k = std::sqrt(3.0f) / 2;
  return {{mx + k * sx, my + k * sy},
          {mx + k * sx, my - k * sy},
          {mx - k * sx, my + k * sy},
          {mx - k * sx, my - k * sy}};
}

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

TEST(FrechetDistanceTest, ClosedFormOfCommutingCovariances) {
  // |mu1 - mu2|^2 + sum (s1 - s2)^2
  EXPECT_NEAR(Frechet(Diagonal(0, 0, 1, 2), Diagonal(3, 4, 5, 1)), 25 + 16 + 1, 1e-4);
  EXPECT_NEAR(Frechet(Diagonal(1, 1, 2, 3), Diagonal(1, 1, 2, 3)), 0, 1e-5);
}

TEST(FrechetDistanceTest, EqualsTheTextbookForm) {
  const FeatureSet a = RandomSet(40, 6, 1), b = RandomSet(30, 6, 2);
  EXPECT_NEAR(Frechet(a, b), TextbookFrechet(a, b), 1e-8);
  EXPECT_NEAR(Frechet(a, b), Frechet(b, a), 1e-9);
}

TEST(FrechetDistanceTest, FewerSamplesThanFeaturesIsExact) {
  const FeatureSet a = RandomSet(5, 40, 3), b = RandomSet(7, 40, 4);
  EXPECT_NEAR(Frechet(a, b), TextbookFrechet(a, b), 1e-3);
  EXPECT_NEAR(Frechet(a, a), 0, 1e-6);
  // Many against few: one factor is reduced, the other is not.
  const FeatureSet many = RandomSet(60, 40, 5);
  EXPECT_NEAR(Frechet(many, a), TextbookFrechet(many, a), 1e-3);
}

TEST(FrechetDistanceTest, SetsWithoutSpreadDifferByTheirMeans) {
  const FeatureSet a(3, {1, 2, 2}), b(4, {0, 0, 0});
  EXPECT_NEAR(Frechet(a, b), 9, 1e-9);
}

TEST(FrechetDistanceTest, InvalidFeatureSetsAreRejected) {
  const FeatureSet good = {{1, 2}, {3, 4}};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const FeatureSet& bad : {FeatureSet{}, FeatureSet{{1, 2}}, FeatureSet{{1, 2}, {3, nan}}}) {
    EXPECT_EQ(FrechetDistance(bad, good).status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_EQ(FrechetDistance(good, bad).status().code(), absl::StatusCode::kInvalidArgument);
  }
}

TEST(DiversityTest, IsTheMeanPairwiseDistance) {
  EXPECT_DOUBLE_EQ(Diversity({{0, 0}, {3, 4}, {0, 4}}), (5 + 4 + 3) / 3.0);
  EXPECT_EQ(Diversity({{1, 1}}), 0);
  EXPECT_EQ(Diversity({}), 0);
}

}  // namespace
}  // namespace duet::evaluation::metrics
