#include "model/evaluation/report/metric_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "model/evaluation/metrics/scores.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::report {
namespace {

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

}  // namespace
}  // namespace duet::evaluation::report
