#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "model/evaluation/metrics/scores.h"
#include "model/evaluation/report/metric_tables.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::report {
namespace {

Table Example() {
  Table table;
  table.title = "Errors | all";
  table.columns = {"kick", "punch"};
  table.rows = {{"ours", {0.504, 0.3}, false},
                {"a, \"b\"", {0.5, std::nan("")}, false},
                {"printed", {0.1, 0.2}, true}};
  table.notes = {"raw unit"};
  table.best = Best::kLowest;
  return table;
}

TEST(TableTest, PlainTextAlignsAndMarksTheBest) {
  EXPECT_EQ(ToPlainText(Example()),
            "Errors | all\n"
            "          kick  punch\n"
            "ours     *0.50  *0.30\n"
            "a, \"b\"   *0.50      -\n"
            "printed   0.10   0.20\n"
            "  raw unit\n");
}

TEST(TableTest, PlainTextCountsCharactersNotBytes) {
  Table table = Example();
  table.rows[2].name = "\u00e9t\u00e9";
  EXPECT_THAT(ToPlainText(table), HasSubstr("\u00e9t\u00e9      0.10   0.20\n"));
}

TEST(TableTest, ZeroHasNoSign) {
  Table table = Example();
  table.rows[0].values = {-0.001, -0.006};
  EXPECT_THAT(ToPlainText(table), HasSubstr("ours     *0.00  *-0.01\n"));
}

TEST(TableTest, HighestAndNoneCanBeBest) {
  Table table = Example();
  table.best = Best::kHighest;
  table.decimals = 3;
  EXPECT_THAT(ToPlainText(table), HasSubstr("*0.504"));
  EXPECT_THAT(ToPlainText(table), testing::Not(HasSubstr("*0.500")));
  table.best = Best::kNone;
  EXPECT_THAT(ToPlainText(table), testing::Not(HasSubstr("*")));
}

TEST(TableTest, MeanColumnIsMissingWhereAFigureIs) {
  Table table = Example();
  AddMeanColumn(&table);
  EXPECT_EQ(table.columns.back(), "mean");
  EXPECT_DOUBLE_EQ(table.rows[0].values.back(), 0.402);
  EXPECT_TRUE(std::isnan(table.rows[1].values.back()));
}

TEST(PaperTablesTest, AreWholeAndMarkedAsPrinted) {
  for (const Table& table : {PaperAfdSbu(), PaperFidSbu(), PaperAugmentation()}) {
    EXPECT_FALSE(table.notes.empty()) << table.title;
    for (const TableRow& row : table.rows) {
      EXPECT_TRUE(row.printed) << row.name;
      EXPECT_EQ(row.values.size(), table.columns.size()) << row.name;
    }
  }
  EXPECT_EQ(PaperAfdSbu().rows.size(), 12u);
  EXPECT_EQ(PaperAfdSbu().rows[6].values[5], .32);
  EXPECT_EQ(PaperAfdSbu().rows[1].values[4], 3.84);
  EXPECT_EQ(PaperFidSbu().rows[0].values[3], 29.5);
  EXPECT_EQ(PaperAugmentation().rows[1].values[0], .996);
}

MetricStyle Style(const std::string& name) {
  for (const MetricStyle& style : MetricStyles()) {
    if (style.name == name) return style;
  }
  ADD_FAILURE() << name;
  return {};
}

std::vector<std::string> RowNames(const Table& table) {
  std::vector<std::string> names;
  for (const TableRow& row : table.rows) names.push_back(row.name);
  return names;
}

TEST(MetricStyles, CoverEveryFigureOnce) {
  std::multiset<std::string> styled;
  for (const MetricStyle& style : MetricStyles()) styled.insert(style.name);
  std::multiset<std::string> wanted = {kAccuracy, kFrechet, kDiversity};
  const dataset::Dataset dataset = test::MadeUpPairs(1);
  const auto captured = metrics::CapturedMotions(dataset, {0});
  for (const auto& [name, score] : ScoreMotion(dataset, captured[0])) wanted.insert(name);
  EXPECT_EQ(styled, wanted);
}

TEST(MetricStyles, OnlyDistancesToCapturedFollowersHaveNoMeaningForThem) {
  std::vector<std::string> without;
  for (const MetricStyle& style : MetricStyles()) {
    if (!style.of_captured) without.push_back(style.name);
  }
  EXPECT_THAT(without,
              ElementsAre("afd", "afd_squared", "afd_m", "afd_squared_m", "root_aligned_afd",
                          "root_aligned_afd_m", "velocity_error", kFrechet));
}

TEST(MetricTable, OmitsMethodsWithoutTheFigure) {
  const std::vector<MethodFigures> methods = {
      {"a", false, {{"afd", {1, 3}}, {"jitter", {5, 7}}}},
      {"b", false, {{"jitter", {6, 8}}}},
      {"captured", true, {{"afd", {0, 0}}, {"jitter", {9, 9}}}}};
  const Table distance = MetricTable(Style("afd"), {"kick", "hug"}, methods);
  EXPECT_THAT(RowNames(distance), ElementsAre("a"));  // captured: 0 by definition
  EXPECT_THAT(distance.columns, ElementsAre("kick", "hug", "mean"));
  EXPECT_THAT(distance.rows[0].values, ElementsAre(1, 3, 2));
  EXPECT_EQ(distance.best, Best::kLowest);
  const Table jitter = MetricTable(Style("jitter"), {"kick", "hug"}, methods);
  EXPECT_THAT(RowNames(jitter), ElementsAre("a", "b", "captured"));
  EXPECT_EQ(jitter.best, Best::kNone);
}

TEST(AddPrintedRows, SetsThePapersRowsApart) {
  const Table paper = PaperFidSbu();
  Table table = MetricTable(Style(kFrechet), paper.columns,
                            {{"ours", false, {{kFrechet, {1, 2, 3, 4, 5, 6}}}}});
  AddPrintedRows(paper, &table);
  ASSERT_EQ(table.rows.size(), 1 + paper.rows.size());
  EXPECT_FALSE(table.rows[0].printed);
  EXPECT_TRUE(table.rows[1].printed);
  EXPECT_EQ(table.rows[1].name, "paper: " + paper.rows[0].name);
  for (const TableRow& row : table.rows) EXPECT_EQ(row.values.size(), table.columns.size());
  EXPECT_EQ(table.notes.back(), paper.notes.back());
}

TEST(AddPrintedRows, OtherClassesGetANoteInsteadOfRows) {
  Table table = MetricTable(Style(kFrechet), {"wave"}, {{"ours", false, {{kFrechet, {1}}}}});
  AddPrintedRows(PaperFidSbu(), &table);
  EXPECT_THAT(RowNames(table), ElementsAre("ours"));
  EXPECT_THAT(table.notes.back(), HasSubstr("no figures for these classes"));
}

std::vector<MethodFigures> Rows() {
  return {{"captured", true, {{"joint_speed", {0.4, 0.2}}, {"range_of_motion_m", {1, 1}}}},
          {"flow", false, {{"joint_speed", {0.2, 0.2}}, {kPooledFrechet, {2}}}},
          {"today", false, {{"joint_speed", {0.1, 0.1}}, {kPooledFrechet, {8}}}}};
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

TEST(SampleTablesTest, EveryAvailableFigureHasATableByClass) {
  const std::vector<Table> tables = SampleTables({"kick", "hug"}, Rows());
  ASSERT_EQ(tables.size(), 4u);  // both ratios and both figures they come from
  EXPECT_THAT(tables[0].columns, ElementsAre("kick", "hug", "mean"));
  EXPECT_EQ(tables[0].rows[1].name, "flow");
  EXPECT_THAT(tables[0].rows[2].values, ElementsAre(0.25, 0.5, 0.375));
}

}  // namespace
}  // namespace duet::evaluation::report
