// The hour command with the checkpoint inside the program, for a few seconds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "model/evaluation/program/commands.h"
#include "tests/evaluation/support/read_section.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::evaluation::program {
namespace {

using test::IsOk;
using test::StatusIs;

using ::testing::ElementsAre;
using ::testing::HasSubstr;

absl::StatusOr<nlohmann::json> RunCommand(std::vector<std::string> words) {
  const duet::test::TemporaryFolder folder;
  words.insert(words.end(), {"--embedded", "--out", folder.path().string()});
  CLI::App app;
  ChosenCommand chosen;
  AddHourCommand(&app, &chosen);
  std::reverse(words.begin(), words.end());  // as CLI11 wants them
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    return absl::InvalidArgumentError(error.what());
  }
  absl::Status status = chosen();
  if (!status.ok()) return status;
  return test::ReadSection(folder.path());
}

TEST(HourCommandTest, HasARowALeader) {
  const auto section = RunCommand({"hour", "--minutes", "0.1", "--delay", "2"});
  ASSERT_THAT(section, IsOk());
  EXPECT_EQ(section->at("id"), "22_hour");
  EXPECT_EQ(section->at("command"),
            "duet-eval hour --minutes 0.1 --delay 2 --out RESULTS --embedded");
  const nlohmann::json& table = section->at("tables").at(0);
  EXPECT_THAT(test::RowNames(table), ElementsAre("idle", "wild", "absent", "teleporting"));
  for (const nlohmann::json& row : table.at("rows")) {
    EXPECT_EQ(row.at("values").at(7), 1) << "the first minute is the last";
    EXPECT_GT(row.at("values").at(5), 0);
  }
}

TEST(HourCommandTest, RejectsALengthThatIsNone) {
  EXPECT_THAT(RunCommand({"hour", "--minutes", "0"}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("--minutes")));
}

}  // namespace
}  // namespace duet::evaluation::program
