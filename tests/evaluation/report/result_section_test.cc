#include "model/evaluation/report/result_section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/evaluation/support/example_section.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::evaluation::report {
namespace {

using nlohmann::json;

using test::ExampleSection;
using test::ReadTestFile;
using test::TemporaryFolder;

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

TEST(ResultSectionTest, InvalidSectionsAreNotWritten) {
  const TemporaryFolder folder;
  const auto problem = [&](const std::function<void(ResultSection*)>& spoil) {
    ResultSection section = ExampleSection("10_folds");
    spoil(&section);
    const absl::Status status = WriteSection(section, folder.path());
    EXPECT_THAT(status, StatusIs(absl::StatusCode::kInvalidArgument, testing::_));
    return std::string(status.message());
  };
  EXPECT_THAT(problem([](ResultSection* s) { s->id = "../up"; }),
              HasSubstr("id: expected 1 to 64 of a-z, 0-9 and _, got \"../up\""));
  EXPECT_THAT(problem([](ResultSection* s) { s->figures[0].name = "A B"; }),
              HasSubstr("figures[0].name: expected 1 to 64"));
  EXPECT_THAT(problem([](ResultSection* s) { s->figures.push_back(s->figures[0]); }),
              HasSubstr("figures[1].name: expected a new name, got \"10_folds_curve\" again"));
  EXPECT_THAT(problem([](ResultSection* s) {
                s->tables[0].rows[0].values[1] = std::numeric_limits<double>::infinity();
              }),
              HasSubstr("tables[0].rows[0].values: expected finite numbers or NaN"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ResultSectionTest, TextThatIsNotUtf8IsReplaced) {
  ResultSection section = ExampleSection("10_folds");
  section.title = "caf\xE9";
  EXPECT_EQ(Written(section)["title"], "caf\uFFFD");
}

TEST(TodayTest, IsADate) {
  EXPECT_THAT(Today(), testing::MatchesRegex("20[0-9][0-9]-[01][0-9]-[0-3][0-9]"));
}

}  // namespace
}  // namespace duet::evaluation::report
