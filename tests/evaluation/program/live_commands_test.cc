// The commands of live followers with the checkpoint inside the program, for a few seconds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/evaluation/support/made_up_captures.h"
#include "tests/evaluation/support/read_section.h"
#include "tests/evaluation/support/run_command.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::program {
namespace {

TEST(HourCommandTest, HasARowALeader) {
  const auto section = test::RunForSection(
      AddHourCommand, {"hour", "--minutes", "0.1", "--delay", "2", "--embedded"});
  ASSERT_THAT(section, IsOk());
  EXPECT_EQ(section->at("id"), "22_hour");
  EXPECT_EQ(section->at("command"),
            "duet-eval hour --minutes 0.1 --delay 2 --out RESULTS --embedded");
  const nlohmann::json& table = section->at("tables").at(0);
  EXPECT_THAT(test::RowNames(table), ElementsAre("idle", "wild", "absent", "teleporting"));
  for (const nlohmann::json& row : table.at("rows")) {
    EXPECT_EQ(row.at("values").at(8), 1) << "the first minute is the last";
    EXPECT_GT(row.at("values").at(6), 0);
  }
}

TEST(HourCommandTest, RejectsALengthThatIsNone) {
  EXPECT_THAT(test::RunCommand(AddHourCommand, {"hour", "--minutes", "0", "--embedded"}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("--minutes")));
}

TEST(LiveCommandTest, HasARowForTheWholeLeaderAndForEachDelay) {
  const dataset::CaptureFolder captures;
  test::WriteSwayingCaptures(captures);
  const auto section = test::RunForSection(
      AddLiveCommand,
      {"live", "--data", captures.path().string(), "--delays", "0,3", "--seed", "4", "--embedded"});
  ASSERT_THAT(section, IsOk());
  EXPECT_EQ(section->at("id"), "21_live");
  EXPECT_EQ(section->at("command"),
            "duet-eval live --data DIR --delays 0,3 --seed 4 --out RESULTS --embedded");
  const nlohmann::json& table = section->at("tables").at(0);
  EXPECT_EQ(table.at("title"), "duet: reactions to 12 leaders");
  EXPECT_THAT(test::RowNames(table),
              ElementsAre("whole leader known", "live, delay 0", "live, delay 3"));
  const nlohmann::json& whole = table.at("rows").at(0).at("values");
  EXPECT_GT(whole.at(5), 0) << "speed";
  EXPECT_EQ(whole.at(6), 1) << "jerk, as a multiple of its own";
}

}  // namespace
}  // namespace duet::evaluation::program
