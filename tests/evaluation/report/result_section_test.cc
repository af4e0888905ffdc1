#include "model/evaluation/report/result_section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "model/evaluation/report/section_json.h"
#include "nlohmann/json.hpp"
#include "tests/evaluation/support/example_section.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::evaluation::report {
namespace {

using test::ExampleSection;
using test::IsOk;
using test::StatusIs;
using test::TemporaryFolder;
using test::WriteTestFile;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;

TEST(ResultSectionTest, ComesBackAsItWasWritten) {
  const TemporaryFolder folder;
  const ResultSection written = ExampleSection("10_folds");
  ASSERT_THAT(WriteSection(written, folder / "new/results"), IsOk());
  const auto sections = ReadSections(folder / "new/results");
  ASSERT_THAT(sections, IsOk());
  ASSERT_EQ(sections->size(), 1u);
  const ResultSection& read = sections->front();
  EXPECT_EQ(read.id, "10_folds");
  EXPECT_EQ(read.title, written.title);
  EXPECT_EQ(read.text, written.text);
  EXPECT_THAT(read.settings, ElementsAre(Pair("data", "SBU"), Pair("seeds", "1, 2")));
  EXPECT_EQ(read.command, written.command);
  EXPECT_EQ(read.date, written.date);
  ASSERT_EQ(read.figures.size(), 1u);
  EXPECT_EQ(read.figures[0].name, "10_folds_curve");
  EXPECT_EQ(read.figures[0].caption, written.figures[0].caption);
  EXPECT_EQ(read.figures[0].svg, written.figures[0].svg);
}

TEST(ResultSectionTest, TablesComeBackExactly) {
  const TemporaryFolder folder;
  ASSERT_THAT(WriteSection(ExampleSection("10_folds"), folder.path()), IsOk());
  const auto sections = ReadSections(folder.path());
  ASSERT_THAT(sections, IsOk());
  const Table& table = sections->front().tables.at(0);
  EXPECT_EQ(table.title, "Errors <raw> & all");
  EXPECT_THAT(table.columns, ElementsAre("kick", "shake_hands"));
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(table.rows[0].values[1], 1.0 / 3);
  EXPECT_FALSE(table.rows[0].printed);
  EXPECT_TRUE(table.rows[1].printed);
  EXPECT_TRUE(std::isnan(table.rows[2].values[1]));
  EXPECT_THAT(table.notes, ElementsAre("lower is better"));
  EXPECT_EQ(table.decimals, 3);
  EXPECT_EQ(table.best, Best::kLowest);
}

TEST(ResultSectionTest, SectionsComeInTheOrderOfTheirIds) {
  const TemporaryFolder folder;
  for (const char* id : {"20_ablation", "60_curves", "10_folds"}) {
    ASSERT_THAT(WriteSection(ExampleSection(id), folder.path()), IsOk());
  }
  const auto sections = ReadSections(folder.path());
  ASSERT_THAT(sections, IsOk());
  ASSERT_EQ(sections->size(), 3u);
  EXPECT_EQ((*sections)[0].id, "10_folds");
  EXPECT_EQ((*sections)[2].id, "60_curves");
}

TEST(ResultSectionTest, WritingReplacesAndLeavesNothingElse) {
  const TemporaryFolder folder;
  ResultSection section = ExampleSection("10_folds");
  ASSERT_THAT(WriteSection(section, folder.path()), IsOk());
  section.title = "Again";
  ASSERT_THAT(WriteSection(section, folder.path()), IsOk());
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    names.push_back(entry.path().filename());
  }
  EXPECT_THAT(names, testing::UnorderedElementsAre("10_folds.json", "10_folds_curve.svg"));
  EXPECT_EQ(ReadSections(folder.path())->front().title, "Again");
}

TEST(ResultSectionTest, RefusesToWriteWhatCouldNotBeRead) {
  const TemporaryFolder folder;
  const auto problem = [&](const std::function<void(ResultSection*)>& spoil) {
    ResultSection section = ExampleSection("10_folds");
    spoil(&section);
    const absl::Status status = WriteSection(section, folder.path());
    EXPECT_THAT(status, StatusIs(kInvalid, testing::_));
    return std::string(status.message());
  };
  EXPECT_THAT(problem([](ResultSection* s) { s->id = "../up"; }), HasSubstr("id: \"../up\""));
  EXPECT_THAT(problem([](ResultSection* s) { s->figures[0].name = "A B"; }),
              HasSubstr("figures[0].name: \"A B\", wanted 1 to 64"));
  EXPECT_THAT(problem([](ResultSection* s) { s->figures.push_back(s->figures[0]); }),
              HasSubstr("\"10_folds_curve\" is repeated"));
  EXPECT_THAT(problem([](ResultSection* s) { s->figures[0].svg = "<html>"; }),
              HasSubstr("10_folds_curve\": begins with \"<html>\""));
  EXPECT_THAT(problem([](ResultSection* s) { s->date = "2023-02-29"; }), HasSubstr("YYYY-MM-DD"));
  EXPECT_THAT(problem([](ResultSection* s) { s->tables[0].rows[1].values.pop_back(); }),
              HasSubstr("tables[0].rows[1].values: 1 came, wanted one for each of the 2 columns"));
  EXPECT_THAT(problem([](ResultSection* s) {
                s->tables[0].rows[0].values[1] = std::numeric_limits<double>::infinity();
              }),
              HasSubstr("tables[0].rows[0].values[1]: string, wanted a number or null"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ResultSectionTest, TextThatIsNoUtf8DoesNotEndTheProgram) {
  ResultSection section = ExampleSection("10_folds");
  section.title = "caf\xE9";
  const auto read = SectionFromJson(SectionToJson(section));
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->title, "caf\uFFFD");
}

TEST(ResultSectionTest, ReadingNamesTheField) {
  const auto problem = [](const std::function<void(nlohmann::json*)>& spoil) {
    nlohmann::json json = nlohmann::json::parse(SectionToJson(ExampleSection("10_folds")));
    spoil(&json);
    const auto section = SectionFromJson(json.dump());
    EXPECT_THAT(section, StatusIs(kInvalid, testing::_));
    return std::string(section.status().message());
  };
  using J = nlohmann::json;
  EXPECT_THAT(problem([](J* j) { j->erase("command"); }), HasSubstr("command: missing"));
  EXPECT_THAT(problem([](J* j) { (*j)["more"] = 1; }), HasSubstr("unknown field \"more\""));
  EXPECT_THAT(problem([](J* j) { (*j)["format_version"] = 2; }), HasSubstr("format_version: 2"));
  EXPECT_THAT(problem([](J* j) { (*j)["tables"][0]["best"] = "least"; }),
              HasSubstr("tables[0].best: \"least\", wanted \"none\""));
  EXPECT_THAT(problem([](J* j) { (*j)["tables"][0]["decimals"] = 99; }),
              HasSubstr("tables[0].decimals: 99"));
  EXPECT_THAT(problem([](J* j) { (*j)["tables"][0]["rows"][2] = "row"; }),
              HasSubstr("tables[0].rows[2]: \"row\", wanted an object"));
  EXPECT_THAT(problem([](J* j) { (*j)["settings"][1]["value"] = 3; }),
              HasSubstr("settings[1].value: 3"));
}

TEST(ResultSectionTest, ReadingNamesTheFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(ReadSections(folder / "absent"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("absent")));
  EXPECT_THAT(ReadSections(folder.path()),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("no .json file")));
  WriteTestFile(folder / "broken.json", "{");
  EXPECT_THAT(ReadSections(folder.path()), StatusIs(kInvalid, HasSubstr("broken.json: not JSON")));
}

TEST(ResultSectionTest, AFileBearsItsSectionsName) {
  const TemporaryFolder folder;
  ASSERT_THAT(WriteSection(ExampleSection("10_folds"), folder.path()), IsOk());
  std::filesystem::rename(folder / "10_folds.json", folder / "20_folds.json");
  EXPECT_THAT(ReadSections(folder.path()),
              StatusIs(kInvalid, HasSubstr("20_folds.json: id: \"10_folds\"")));
}

TEST(ResultSectionTest, FiguresMustBeThereAndHaveNamesOfTheirOwn) {
  const TemporaryFolder folder;
  ASSERT_THAT(WriteSection(ExampleSection("10_folds"), folder.path()), IsOk());
  ResultSection second = ExampleSection("20_folds");
  second.figures[0].name = "10_folds_curve";
  ASSERT_THAT(WriteSection(second, folder.path()), IsOk());
  EXPECT_THAT(ReadSections(folder.path()),
              StatusIs(kInvalid, HasSubstr("\"10_folds_curve\" is a figure of an earlier")));
  std::filesystem::remove(folder / "10_folds_curve.svg");
  EXPECT_THAT(ReadSections(folder.path()),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("10_folds_curve.svg")));
}

TEST(TodayTest, IsADate) {
  EXPECT_THAT(Today(), testing::MatchesRegex("20[0-9][0-9]-[01][0-9]-[0-3][0-9]"));
}

}  // namespace
}  // namespace duet::evaluation::report
