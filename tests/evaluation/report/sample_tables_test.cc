#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/evaluation/report/metric_tables.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::report {
namespace {

std::vector<MethodFigures> Rows() {
  return {{"captured", true, {{"joint_speed", {0.4, 0.2}}, {"range_of_motion_m", {1, 1}}}},
          {"flow", false, {{"joint_speed", {0.2, 0.2}}, {kPooledFrechet, {2}}}},
          {"today", false, {{"joint_speed", {0.1, 0.1}}, {kPooledFrechet, {8}}}},
          {"flow", false, {{"joint_speed", {0.4, 0.1}}, {kPooledFrechet, {4}}}}};
}

double Cell(const Table& table, const std::string& row, const std::string& column) {
  const auto at = std::find(table.columns.begin(), table.columns.end(), column);
  for (const TableRow& other : table.rows) {
    if (other.name == row) return other.values[static_cast<size_t>(at - table.columns.begin())];
  }
  ADD_FAILURE() << row;
  return 0;
}

TEST(SampleTablesTest, TheSummaryHasRatiosToCaptured) {
  const Table table = SampleSummary(Rows());
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_NEAR(Cell(table, "captured", "speed ratio"), 1, 1e-9);
  EXPECT_NEAR(Cell(table, "today", "speed ratio"), (0.25 + 0.5) / 2, 1e-9);
  EXPECT_EQ(Cell(table, "today", "FID"), 8);
  EXPECT_TRUE(std::isnan(Cell(table, "today", "range ratio")));
}

TEST(SampleTablesTest, RowsOfOneNameBecomeTheirMeanAndSpread) {
  const Table mean = SampleSummary(Rows());
  EXPECT_NEAR(Cell(mean, "flow", "FID"), 3, 1e-9);
  // Ratios (0.5, 1) and (1, 0.5).
  EXPECT_NEAR(Cell(mean, "flow", "speed ratio"), 0.75, 1e-9);
  const Table spread = SampleSpread(Rows());
  ASSERT_EQ(spread.rows.size(), 1u);
  EXPECT_NEAR(Cell(spread, "flow", "FID"), std::sqrt(2), 1e-9);
}

TEST(SampleTablesTest, EveryAvailableFigureHasATableByClass) {
  const std::vector<Table> tables = SampleTables({"kick", "hug"}, Rows());
  ASSERT_EQ(tables.size(), 4u);  // both ratios and both figures they come from
  EXPECT_THAT(tables[0].columns, ElementsAre("kick", "hug", "mean"));
  EXPECT_EQ(tables[0].rows[1].name, "flow");
  EXPECT_THAT(tables[0].rows[2].values, ElementsAre(0.25, 0.5, 0.375));
}

}  // namespace
}  // namespace duet::evaluation::report
