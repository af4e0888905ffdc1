#include "model/evaluation/experiments/trials.h"

#include <gtest/gtest.h>

#include <cmath>

namespace duet::evaluation::experiments {
namespace {

Trials ThreeTrials() {
  Trials trials({"kick", "all"});
  trials.Add("real", "1", {0.5, 0.6});
  trials.Add("real", "2", {0.7, 0.8});
  trials.Add("real", "3", {0.9, 1.0});
  trials.Add("more", "1", {0.6, 0.5});
  trials.Add("more", "3", {1.0, 0.7});
  return trials;
}

TEST(TrialsTest, SummariesKeepTheRowsInOrder) {
  const std::vector<TrialSummary> summaries = ThreeTrials().Summaries();
  ASSERT_EQ(summaries.size(), 2u);
  EXPECT_EQ(summaries[0].row, "real");
  EXPECT_DOUBLE_EQ(summaries[0].means[0], 0.7);
  EXPECT_DOUBLE_EQ(summaries[0].deviations[1], 0.2);
  EXPECT_EQ(summaries[0].above_zero[0], 1);
  EXPECT_EQ(summaries[1].row, "more");
  EXPECT_DOUBLE_EQ(summaries[1].means[1], 0.6);
}

TEST(TrialsTest, GainsArePairedOverCommonTrials) {
  const std::vector<TrialSummary> gains = ThreeTrials().Gains("real");
  ASSERT_EQ(gains.size(), 1u);
  EXPECT_EQ(gains[0].row, "more");
  EXPECT_NEAR(gains[0].means[0], 0.1, 1e-12);     // .1 and .1
  EXPECT_NEAR(gains[0].deviations[0], 0, 1e-12);  // no spread
  EXPECT_EQ(gains[0].above_zero[0], 1);           // always above
  EXPECT_NEAR(gains[0].means[1], -0.2, 1e-12);    // -.1 and -.3
  EXPECT_NEAR(gains[0].deviations[1], std::sqrt(0.02), 1e-12);
  EXPECT_EQ(gains[0].above_zero[1], 0);
}

TEST(TrialsTest, GainsWithoutTheBaseAreEmpty) {
  EXPECT_TRUE(ThreeTrials().Gains("nothing").empty());
}

}  // namespace
}  // namespace duet::evaluation::experiments
