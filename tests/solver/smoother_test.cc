#include "model/solver/smoother.h"

#include <gtest/gtest.h>

#include <cmath>

namespace duet::solver {
namespace {

constexpr CorrectionCost kCost = {10, 0.3, 0.02};

// What SmoothCorrection minimises.
double CostOf(const std::vector<double>& d, const std::vector<double>& weights,
              const std::vector<double>& wishes) {
  const double s = kCost.seconds * kCost.frame_rate_hz;
  double cost = 0;
  for (std::size_t t = 0; t < d.size(); ++t) {
    cost += weights[t] * std::pow(d[t] - wishes[t], 2) + kCost.near * d[t] * d[t];
    if (t + 1 < d.size()) cost += s * s * std::pow(d[t + 1] - d[t], 2);
    if (t + 2 < d.size()) cost += std::pow(s, 4) / 4 * std::pow(d[t] - 2 * d[t + 1] + d[t + 2], 2);
  }
  return cost;
}

TEST(SmoothCorrectionTest, NoOtherCorrectionCostsLess) {
  const std::vector<double> weights = {1, 0, 0, 2, 1, 0, 1, 1};
  const std::vector<double> wishes = {0.1, 9, 9, -0.3, 0.2, 9, 0, 0.4};
  const std::vector<double> best = SmoothCorrection(kCost, weights, wishes);
  ASSERT_EQ(best.size(), wishes.size());
  const double least = CostOf(best, weights, wishes);
  for (std::size_t t = 0; t < best.size(); ++t) {
    for (const double step : {-1e-3, 1e-3}) {
      std::vector<double> other = best;
      other[t] += step;
      EXPECT_GT(CostOf(other, weights, wishes), least) << t << " " << step;
    }
  }
}

TEST(SmoothCorrectionTest, GivenFramesAreNotCorrectedAndTheRestLeavesThemSmoothly) {
  CorrectionCost cost = kCost;
  cost.given = 10;
  const std::vector<double> best =
      SmoothCorrection(cost, std::vector<double>(40, 1), std::vector<double>(40, 1));
  for (std::size_t t = 0; t < 10; ++t) EXPECT_NEAR(best[t], 0, 1e-6) << t;
  for (std::size_t t = 10; t < 20; ++t) EXPECT_LT(best[t] - best[t - 1], 0.3) << t;
  EXPECT_NEAR(best.back(), 1, 0.05);
}

TEST(SmoothCorrectionTest, ThreeCoordinatesAreSolvedAsOne) {
  const std::vector<double> weights = {1, 0, 2, 1};
  const std::vector<motion::Vec3> wishes = {{1, 0, -1}, {}, {2, 1, 0}, {0, 3, 1}};
  const std::vector<motion::Vec3> all = SmoothShift(kCost, weights, wishes);
  const std::vector<double> y = SmoothCorrection(kCost, weights, {0, 0, 1, 3});
  for (std::size_t t = 0; t < 4; ++t) EXPECT_NEAR(all[t].y, y[t], 1e-6) << t;
}

}  // namespace
}  // namespace duet::solver
