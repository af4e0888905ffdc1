#include "model/evaluation/report/result_section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::evaluation::report {
namespace {

using nlohmann::json;

using test::ReadTestFile;
using test::TemporaryFolder;

// A section with one of everything: texts that need escaping, a table with best, missing and
// printed figures, a figure, settings.
ResultSection ExampleSection(const std::string& id) {
  Table table;
  table.title = "Errors <raw> & all";
  table.columns = {"kick", "shake_hands"};
  table.rows = {{"ours", {0.504, 1.0 / 3}, false},
                {"paper", {0.1, 0.2}, true},
                {"frozen_first_frame", {0.7, std::nan("")}, false}};
  table.notes = {"lower is better"};
  table.decimals = 3;
  table.best = Best::kLowest;
  ResultSection section;
  section.id = id;
  section.title = "Methods & classes";
  section.text = {"First <paragraph>.", "Second one."};
  section.tables = {table};
  section.figures = {{id + "_curve", "A curve of \"errors\".", {{"kind", "latent"}}}};
  section.settings = {{"data", "SBU"}, {"seeds", "1, 2"}};
  section.command = "duet-eval folds --data DIR";
  section.date = "2024-02-29";
  return section;
}

json Written(const ResultSection& section) {
  const TemporaryFolder folder;
  EXPECT_THAT(WriteSection(section, folder / "new/results"), IsOk());
  return json::parse(ReadTestFile(folder / "new/results" / (section.id + ".json")));
}

TEST(ResultSectionTest, JsonHasEveryField) {
  const json section = Written(ExampleSection("10_folds"));
  EXPECT_EQ(section["format_version"], 1);
  EXPECT_EQ(section["id"], "10_folds");
  EXPECT_EQ(section["title"], "Methods & classes");
  EXPECT_EQ(section["text"], json::parse(R"(["First <paragraph>.", "Second one."])"));
  EXPECT_EQ(section["settings"][1], json::parse(R"({"name": "seeds", "value": "1, 2"})"));
  EXPECT_EQ(section["command"], "duet-eval folds --data DIR");
  EXPECT_EQ(section["date"], "2024-02-29");
  ASSERT_EQ(section["figures"].size(), 1u);
  EXPECT_EQ(section["figures"][0]["name"], "10_folds_curve");
  EXPECT_EQ(section["figures"][0]["caption"], "A curve of \"errors\".");
  EXPECT_EQ(section["figures"][0]["plot"]["kind"], "latent");
}

TEST(ResultSectionTest, JsonKeepsTheFiguresOfTablesExactly) {
  const json table = Written(ExampleSection("10_folds"))["tables"][0];
  EXPECT_EQ(table["title"], "Errors <raw> & all");
  EXPECT_EQ(table["columns"], json::parse(R"(["kick", "shake_hands"])"));
  ASSERT_EQ(table["rows"].size(), 3u);
  EXPECT_EQ(table["rows"][0]["values"][1], 1.0 / 3);
  EXPECT_EQ(table["rows"][0]["printed"], false);
  EXPECT_EQ(table["rows"][1]["printed"], true);
  EXPECT_TRUE(table["rows"][2]["values"][1].is_null());
  EXPECT_EQ(table["notes"][0], "lower is better");
  EXPECT_EQ(table["decimals"], 3);
  EXPECT_EQ(table["best"], "lowest");
}

TEST(ResultSectionTest, WritingReplacesTheFile) {
  const TemporaryFolder folder;
  ResultSection section = ExampleSection("10_folds");
  ASSERT_THAT(WriteSection(section, folder.path()), IsOk());
  section.title = "Again";
  ASSERT_THAT(WriteSection(section, folder.path()), IsOk());
  EXPECT_EQ(json::parse(ReadTestFile(folder / "10_folds.json"))["title"], "Again");
}

TEST(ResultSectionTest, AnIdThatIsNoNameIsRejected) {
  const TemporaryFolder folder;
  EXPECT_THAT(WriteSection(ExampleSection("../up"), folder.path()),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("id: expected 1 to 64 of a-z, 0-9 and _, got \"../up\"")));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ResultSectionTest, TextThatIsNotUtf8IsReplaced) {
  ResultSection section = ExampleSection("10_folds");
  section.title = "caf\xE9";
  EXPECT_EQ(Written(section)["title"], "caf\uFFFD");
}

}  // namespace
}  // namespace duet::evaluation::report
