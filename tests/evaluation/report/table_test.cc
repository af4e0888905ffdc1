#include "model/evaluation/report/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/evaluation/report/metric_tables.h"
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

TEST(TableTest, LargeFiguresAreWhole) {
  Table table = Example();
  table.rows[0].values[0] = -1e300;
  EXPECT_GT(ToPlainText(table).size(), 4u * 300);
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
  EXPECT_EQ(PaperAfdSbu().decimals, 2);  // as it is printed
  EXPECT_EQ(PaperAfdSbu().rows[6].values[5], .32);
  EXPECT_EQ(PaperAfdSbu().rows[1].values[4], 3.84);
  EXPECT_EQ(PaperFidSbu().rows[0].values[3], 29.5);
  EXPECT_EQ(PaperAugmentation().rows[1].values[0], .996);
}

}  // namespace
}  // namespace duet::evaluation::report
