#include "model/evaluation/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "model/evaluation/metrics/scores.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::evaluation::report {
namespace {

using nlohmann::json;

Table Example() {
  Table table;
  table.title = "Errors | all";
  table.columns = {"kick", "punch"};
  table.rows = {{"ours", {0.504, 1.0 / 3}}, {"a, \"b\"", {0.5, std::nan("")}}, {"hmm", {0.1, 0.2}}};
  table.notes = {"raw unit"};
  table.best = Best::kLowest;
  return table;
}

TEST(TableTest, PlainTextAligns) {
  EXPECT_EQ(ToPlainText(Example()),
            "Errors | all\n"
            "        kick  punch\n"
            "ours    0.50   0.33\n"
            "a, \"b\"  0.50      -\n"
            "hmm     0.10   0.20\n"
            "  raw unit\n");
}

TEST(SectionTest, JsonHasEveryFieldAndTheExactFigures) {
  const test::TemporaryFolder folder;
  Section section;
  section.id = "10_folds";
  section.title = "caf\xE9";
  section.text = {"First.", "Second."};
  section.tables = {Example()};
  section.figures = {{"curve", "A curve.", {{"kind", "latent"}}}};
  section.settings = {{"data", "SBU"}};
  section.command = "duet-eval folds --data FOLDER";
  ASSERT_THAT(WriteSection(section, folder / "new/results"), IsOk());
  const json read = json::parse(test::ReadTestFile(folder / "new/results/10_folds.json"));
  EXPECT_EQ(read["format_version"], 1);
  EXPECT_EQ(read["id"], "10_folds");
  EXPECT_EQ(read["title"], "caf\uFFFD");  // not UTF-8
  EXPECT_EQ(read["text"], json({"First.", "Second."}));
  EXPECT_EQ(read["settings"], json::parse(R"([{"name": "data", "value": "SBU"}])"));
  EXPECT_EQ(read["command"], "duet-eval folds --data FOLDER");
  EXPECT_EQ(read["date"].get<std::string>().size(), 10u);
  EXPECT_EQ(read["figures"][0]["plot"]["kind"], "latent");
  const json& table = read["tables"][0];
  EXPECT_EQ(table["columns"], json({"kick", "punch"}));
  EXPECT_EQ(table["rows"][0]["values"][1], 1.0 / 3);
  EXPECT_TRUE(table["rows"][1]["values"][1].is_null());
  EXPECT_EQ(table["notes"][0], "raw unit");
  EXPECT_EQ(table["decimals"], 2);
  EXPECT_EQ(table["best"], "lowest");
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

TEST(MetricTable, OmitsMethodsWithoutTheFigure) {
  const std::vector<MethodFigures> methods = {{"a", {{"afd", {1, 3}}, {"jitter", {5, 7}}}},
                                              {"b", {{"jitter", {6, 8}}}},
                                              {"captured", {{"afd", {0, 0}}, {"jitter", {9, 9}}}}};
  const Table distance = MetricTable(Style("afd"), {"kick", "hug"}, methods);
  EXPECT_THAT(RowNames(distance), ElementsAre("a"));  // captured: 0 by definition
  EXPECT_THAT(distance.columns, ElementsAre("kick", "hug", "mean"));
  EXPECT_THAT(distance.rows[0].values, ElementsAre(1, 3, 2));
  EXPECT_THAT(RowNames(MetricTable(Style("jitter"), {"kick", "hug"}, methods)),
              ElementsAre("a", "b", "captured"));
}

TEST(MetricTable, MeanIsMissingWhereAFigureIs) {
  const Table table =
      MetricTable(Style("afd"), {"kick", "hug"},
                  {{"a", {{"afd", {0.1, 0.2}}}}, {"b", {{"afd", {0.5, std::nan("")}}}}});
  EXPECT_DOUBLE_EQ(table.rows[0].values.back(), 0.15);
  EXPECT_TRUE(std::isnan(table.rows[1].values.back()));
}

TEST(SampleSummaryTest, HasRatiosToCaptured) {
  const Table table =
      SampleSummary({{"captured", {{"joint_speed", {0.4, 0.2}}, {"range_of_motion_m", {1, 1}}}},
                     {"flow", {{"joint_speed", {0.1, 0.1}}, {kPooledFrechet, {8}}}}});
  const auto cell = [&](size_t row, const std::string& column) {
    const auto at = std::find(table.columns.begin(), table.columns.end(), column);
    return table.rows[row].values[static_cast<size_t>(at - table.columns.begin())];
  };
  EXPECT_NEAR(cell(0, "speed ratio"), 1, 1e-9);
  EXPECT_NEAR(cell(1, "speed ratio"), (0.25 + 0.5) / 2, 1e-9);
  EXPECT_EQ(cell(1, "FID"), 8);
  EXPECT_TRUE(std::isnan(cell(1, "range ratio")));
}

}  // namespace
}  // namespace duet::evaluation::report
