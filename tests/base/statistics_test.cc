#include "model/base/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace duet::base {
namespace {

TEST(MeanTest, IgnoresMissingValues) {
  EXPECT_EQ(Mean({1, std::nan(""), 4}), 2.5);
  EXPECT_TRUE(std::isnan(Mean({std::nan("")})));
  EXPECT_TRUE(std::isnan(Mean({})));
}

TEST(QuantileTest, LiesBetweenNeighbours) {
  EXPECT_DOUBLE_EQ(Quantile({40, 10, 30, 20}, 0.5), 25);
  EXPECT_DOUBLE_EQ(Quantile({40, 10, 30, 20}, 0.9), 37);
  EXPECT_EQ(Quantile({7}, 0.9), 7);
  EXPECT_TRUE(std::isnan(Quantile({}, 0.5)));
}

TEST(SummariseTest, MeanAndSampleDeviation) {
  const MeanAndDeviation summary = Summarise({1, 2, 3, 6});
  EXPECT_DOUBLE_EQ(summary.mean, 3);
  EXPECT_DOUBLE_EQ(summary.deviation, std::sqrt(14.0 / 3));
}

TEST(SummariseTest, TooFewValuesHaveNoDeviation) {
  EXPECT_EQ(Summarise({4}).mean, 4);
  EXPECT_TRUE(std::isnan(Summarise({4}).deviation));
  EXPECT_TRUE(std::isnan(Summarise({}).mean));
}

}  // namespace
}  // namespace duet::base
