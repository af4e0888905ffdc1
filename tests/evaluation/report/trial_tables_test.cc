#include "model/evaluation/report/trial_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/matchers.h"

namespace duet::evaluation::report {
namespace {

experiments::Trials TwoRows() {
  experiments::Trials trials({"kick", "all"});
  trials.Add("real", "1", {0.5, 0.75});
  trials.Add("real", "2", {0.5, 0.25});
  trials.Add("more", "1", {0.75, 0.75});
  trials.Add("more", "2", {0.25, 0.75});
  return trials;
}

TEST(TrialTablesTest, MeansMarkTheHighest) {
  const Table means = MeansTable("means", TwoRows());
  EXPECT_EQ(means.title, "means");
  EXPECT_THAT(means.columns, ElementsAre("kick", "all"));
  ASSERT_EQ(means.rows.size(), 2u);
  EXPECT_EQ(means.rows[0].name, "real");
  EXPECT_THAT(means.rows[1].values, ElementsAre(0.5, 0.75));
  EXPECT_EQ(means.best, Best::kHighest);
}

TEST(TrialTablesTest, DeviationsMarkNone) {
  const Table deviations = DeviationsTable("deviations", TwoRows());
  EXPECT_THAT(deviations.rows.at(0).values, ElementsAre(0, DoubleEq(std::sqrt(0.125))));
  EXPECT_EQ(deviations.best, Best::kNone);
}

TEST(TrialTablesTest, GainHasMeanDeviationAndShareRows) {
  const Table gains = GainsTable("gains", TwoRows(), "real");
  ASSERT_EQ(gains.rows.size(), 3u);
  EXPECT_EQ(gains.rows[0].name, "more");
  EXPECT_THAT(gains.rows[0].values, ElementsAre(0, 0.25));
  EXPECT_EQ(gains.rows[1].name, "more, deviation");
  EXPECT_THAT(gains.rows[1].values,
              ElementsAre(DoubleEq(std::sqrt(0.125)), DoubleEq(std::sqrt(0.125))));
  EXPECT_EQ(gains.rows[2].name, "more, share above 0");
  EXPECT_THAT(gains.rows[2].values, ElementsAre(0.5, 0.5));
}

TEST(TrialTablesTest, GainsWithoutTheBaseRowAreEmpty) {
  EXPECT_TRUE(GainsTable("gains", TwoRows(), "nothing").rows.empty());
}

}  // namespace
}  // namespace duet::evaluation::report
