#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/evaluation/experiments/augmentation.h"
#include "tests/support/matchers.h"

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

TEST(TrialsTest, MeansKeepTheRowsInOrderAndMarkTheHighest) {
  const report::Table means = ThreeTrials().Means("means");
  EXPECT_EQ(means.title, "means");
  EXPECT_THAT(means.columns, ElementsAre("kick", "all"));
  ASSERT_EQ(means.rows.size(), 2u);
  EXPECT_EQ(means.rows[0].name, "real");
  EXPECT_THAT(means.rows[0].values, ElementsAre(DoubleEq(0.7), DoubleEq(0.8)));
  EXPECT_EQ(means.rows[1].name, "more");
  EXPECT_THAT(means.rows[1].values, ElementsAre(DoubleEq(0.8), DoubleEq(0.6)));
  EXPECT_EQ(means.best, report::Best::kHighest);
}

TEST(TrialsTest, DeviationsMarkNone) {
  const report::Table deviations = ThreeTrials().Deviations("deviations");
  EXPECT_THAT(deviations.rows.at(0).values, ElementsAre(DoubleEq(0.2), DoubleEq(0.2)));
  EXPECT_EQ(deviations.best, report::Best::kNone);
}

TEST(TrialsTest, GainsArePairedOverCommonTrials) {
  const report::Table gains = ThreeTrials().Gains("gains", "real");
  ASSERT_EQ(gains.rows.size(), 3u);
  EXPECT_EQ(gains.rows[0].name, "more");
  EXPECT_THAT(gains.rows[0].values,  // .1 and .1; -.1 and -.3
              ElementsAre(DoubleNear(0.1, 1e-12), DoubleNear(-0.2, 1e-12)));
  EXPECT_EQ(gains.rows[1].name, "more, deviation");
  EXPECT_THAT(gains.rows[1].values,
              ElementsAre(DoubleNear(0, 1e-12), DoubleNear(std::sqrt(0.02), 1e-12)));
  EXPECT_EQ(gains.rows[2].name, "more, share above 0");
  EXPECT_THAT(gains.rows[2].values, ElementsAre(1, 0));
}

TEST(TrialsTest, GainsWithoutTheBaseAreEmpty) {
  EXPECT_TRUE(ThreeTrials().Gains("gains", "nothing").rows.empty());
}

}  // namespace
}  // namespace duet::evaluation::experiments
