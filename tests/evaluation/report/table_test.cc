#include "model/evaluation/report/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/evaluation/report/paper_tables.h"
#include "nlohmann/json.hpp"

namespace duet::evaluation::report {
namespace {

using testing::HasSubstr;

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
  const std::vector<std::vector<TableCell>> cells = FormatCells(table);
  EXPECT_EQ(cells[0][0].text, "0.00");
  EXPECT_EQ(cells[0][1].text, "-0.01");
}

TEST(TableTest, LargeFiguresAreWhole) {
  Table table = Example();
  table.rows[0].values[0] = -1e300;
  EXPECT_EQ(FormatCells(table)[0][0].text.size(), 1u + 301u + 3u);
}

TEST(TableTest, MarkdownMarksTheBestAndSetsPrintedRowsApart) {
  EXPECT_EQ(ToMarkdown(Example()),
            "**Errors \\| all**\n\n"
            "| | kick | punch |\n"
            "|---|---:|---:|\n"
            "| ours | **0.50** | **0.30** |\n"
            "| a, \"b\" | **0.50** | - |\n"
            "| *printed* | 0.10 | 0.20 |\n"
            "\nraw unit\n");
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

TEST(TableTest, CsvKeepsTheFiguresExactly) {
  EXPECT_EQ(ToCsv(Example()),
            "row,printed,kick,punch\n"
            "ours,false,0.504,0.3\n"
            "\"a, \"\"b\"\"\",false,0.5,\n"
            "printed,true,0.1,0.2\n");
}

TEST(TableTest, JsonKeepsTheFiguresExactly) {
  const nlohmann::json json = nlohmann::json::parse(ToJson(Example()));
  EXPECT_EQ(json["title"], "Errors | all");
  EXPECT_EQ(json["rows"][0]["values"][0], 0.504);
  EXPECT_TRUE(json["rows"][1]["values"][1].is_null());
  EXPECT_EQ(json["rows"][2]["printed"], true);
  EXPECT_EQ(json["notes"][0], "raw unit");
  EXPECT_EQ(json["decimals"], 2);
  EXPECT_EQ(json["best"], "lowest");
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
