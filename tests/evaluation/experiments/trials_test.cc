#include "model/evaluation/experiments/trials.h"

#include <gtest/gtest.h>

#include <cmath>

namespace duet::evaluation::experiments {
namespace {

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

Trials ThreeTrials() {
  Trials trials({"kick", "all"});
  trials.Add("real", "1", {0.5, 0.6});
  trials.Add("real", "2", {0.7, 0.8});
  trials.Add("real", "3", {0.9, 1.0});
  trials.Add("more", "1", {0.6, 0.5});
  trials.Add("more", "3", {1.0, 0.7});
  return trials;
}

TEST(TrialsTest, TablesKeepTheRowsInOrder) {
  const report::Table means = ThreeTrials().Means("means");
  ASSERT_EQ(means.rows.size(), 2u);
  EXPECT_EQ(means.rows[0].name, "real");
  EXPECT_DOUBLE_EQ(means.rows[0].values[0], 0.7);
  EXPECT_DOUBLE_EQ(means.rows[1].values[1], 0.6);
  EXPECT_DOUBLE_EQ(ThreeTrials().Deviations("deviations").rows[0].values[1], 0.2);
}

TEST(TrialsTest, GainsArePairedOverCommonTrials) {
  const report::Table gains = ThreeTrials().Gains("real", "gains");
  ASSERT_EQ(gains.rows.size(), 3u);
  EXPECT_EQ(gains.rows[0].name, "more");
  EXPECT_NEAR(gains.rows[0].values[0], 0.1, 1e-12);   // .1 and .1
  EXPECT_NEAR(gains.rows[1].values[0], 0, 1e-12);     // no spread
  EXPECT_EQ(gains.rows[2].values[0], 1);              // always above
  EXPECT_NEAR(gains.rows[0].values[1], -0.2, 1e-12);  // -.1 and -.3
  EXPECT_NEAR(gains.rows[1].values[1], std::sqrt(0.02), 1e-12);
  EXPECT_EQ(gains.rows[2].values[1], 0);
}

TEST(TrialsTest, GainsWithoutTheBaseAreEmpty) {
  EXPECT_TRUE(ThreeTrials().Gains("nothing", "gains").rows.empty());
}

}  // namespace
}  // namespace duet::evaluation::experiments
