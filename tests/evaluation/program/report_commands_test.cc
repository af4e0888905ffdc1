// The commands that need no data set: curves and report.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>

#include "model/evaluation/program/commands.h"
#include "model/evaluation/report/result_section.h"
#include "tests/evaluation/support/example_section.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::evaluation::program {
namespace {

using test::ExampleSection;
using test::IsOk;
using test::ReadTestFile;
using test::StatusIs;
using test::TemporaryFolder;
using test::WriteTestFile;

using testing::HasSubstr;

// What the command line does, without its program's name.
absl::Status RunCommand(std::vector<std::string> words) {
  CLI::App app;
  ChosenCommand chosen;
  AddCurvesCommand(&app, &chosen);
  AddReportCommand(&app, &chosen);
  std::reverse(words.begin(), words.end());  // as CLI11 wants them
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    return absl::InvalidArgumentError(error.what());
  }
  return chosen();
}

constexpr char kLog[] = "epoch,reconstruction,seconds\n1,3,0.5\n2,2,0.5\n";

TEST(CurvesCommandTest, WritesASectionThatNamesTheRuns) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "runs/s01");
  WriteTestFile(folder / "runs/s01/log.csv", kLog);
  const std::string run = folder / "runs/s01/";
  ASSERT_THAT(RunCommand({"curves", "--run", run, "other=" + run, "--out", folder / "results"}),
              IsOk());
  const auto sections = report::ReadSections(folder / "results");
  ASSERT_THAT(sections, IsOk());
  const report::ResultSection& section = sections->at(0);
  EXPECT_EQ(section.id, "60_curves");
  EXPECT_EQ(section.title, "Training curves");
  EXPECT_EQ(section.tables.at(0).rows.at(0).name, "s01");
  EXPECT_EQ(section.tables.at(0).rows.at(1).name, "other");
  EXPECT_EQ(section.figures.at(0).name, "60_curves_reconstruction");
  EXPECT_EQ(section.command, "duet-eval curves --run s01=RUN other=RUN");
}

TEST(CurvesCommandTest, IdAndTitleCanBeGiven) {
  const TemporaryFolder folder;
  WriteTestFile(folder / "log.csv", kLog);
  ASSERT_THAT(RunCommand({"curves", "--run", "a=" + folder.path().string(), "--id", "61_more",
                          "--title", "More", "--out", folder / "results"}),
              IsOk());
  const auto sections = report::ReadSections(folder / "results");
  ASSERT_THAT(sections, IsOk());
  EXPECT_EQ(sections->at(0).id, "61_more");
  EXPECT_EQ(sections->at(0).title, "More");
}

TEST(CurvesCommandTest, NamesTheRunThatCannotBeRead) {
  const TemporaryFolder folder;
  EXPECT_THAT(RunCommand({"curves", "--run", folder / "absent"}),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("absent/log.csv")));
  WriteTestFile(folder / "log.csv", "epoch,bone\n1,x\n");
  EXPECT_THAT(RunCommand({"curves", "--run", "a=" + folder.path().string()}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("log.csv:2: bone")));
}

TEST(ReportCommandTest, WritesTheReportAndItsPictures) {
  const TemporaryFolder folder;
  ASSERT_THAT(WriteSection(ExampleSection("10_folds"), folder / "results"), IsOk());
  ASSERT_THAT(RunCommand({"report", "--results", folder / "results", "--out", folder / "report",
                          "--title", "All of it"}),
              IsOk());
  EXPECT_THAT(ReadTestFile(folder / "report/index.html"), HasSubstr("<h1>All of it</h1>"));
  EXPECT_THAT(ReadTestFile(folder / "report/report.md"), HasSubstr("# All of it\n"));
  EXPECT_THAT(ReadTestFile(folder / "report/10_folds_curve.svg"), HasSubstr("<svg "));
  EXPECT_EQ(ReadTestFile(folder / "report/10_folds_curve.png").substr(1, 3), "PNG");
}

TEST(ReportCommandTest, IsWholeWithoutTheProgramThatDrawsPictures) {
  const TemporaryFolder folder;
  ASSERT_THAT(WriteSection(ExampleSection("10_folds"), folder / "results"), IsOk());
  const std::string path = getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  testing::internal::CaptureStderr();
  const absl::Status status =
      RunCommand({"report", "--results", folder / "results", "--out", folder / "report"});
  const std::string heard = testing::internal::GetCapturedStderr();
  setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(status, IsOk());
  EXPECT_THAT(heard, HasSubstr("rsvg-convert is not installed (Debian: librsvg2-bin)"));
  EXPECT_TRUE(std::filesystem::exists(folder / "report/index.html"));
  EXPECT_FALSE(std::filesystem::exists(folder / "report/10_folds_curve.png"));
}

TEST(ReportCommandTest, SaysThatThereIsNothingToReport) {
  const TemporaryFolder folder;
  EXPECT_THAT(RunCommand({"report", "--results", folder.path(), "--out", folder / "report"}),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("no .json file")));
  EXPECT_FALSE(std::filesystem::exists(folder / "report"));
}

}  // namespace
}  // namespace duet::evaluation::program
