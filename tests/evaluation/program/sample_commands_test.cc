// The commands of sampled answers on made-up captures, with the checkpoint inside the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/evaluation/support/made_up_captures.h"
#include "tests/evaluation/support/run_command.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::program {
namespace {

using test::RowNames;

absl::StatusOr<nlohmann::json> RunCommand(test::AddCommand add, std::vector<std::string> words) {
  const dataset::CaptureFolder captures;
  test::WriteSwayingCaptures(captures);
  words.insert(words.end(),
               {"--data", captures.path().string(), "--embedded", "--subjects", "s01"});
  return test::RunForSection(add, std::move(words));
}

TEST(SampleCommandsTest, SamplesHasARowAStart) {
  const auto section =
      RunCommand(AddSamplesCommand, {"samples", "--samples", "2", "--starts", "none,pose"});
  ASSERT_THAT(section, IsOk());
  EXPECT_EQ(section->at("id"), "14_samples");
  EXPECT_THAT(RowNames(section->at("tables").at(0)),
              ElementsAre("captured", "other people", "duet", "duet+pose"));
  EXPECT_EQ(section->at("command"),
            "duet-eval samples --data DIR --subjects s01 --out RESULTS --starts none,pose "
            "--samples 2 --embedded");
}

TEST(SampleCommandsTest, MixesHasTablesForEveryMeasureAndStart) {
  const auto section = RunCommand(AddMixesCommand, {"mixes", "--leaders", "1", "--starts",
                                                    "none,pose", "--reaction-classes", "kick"});
  ASSERT_THAT(section, IsOk());
  std::vector<std::string> titles;
  for (const nlohmann::json& table : section->at("tables")) titles.push_back(table.at("title"));
  ASSERT_THAT(titles, SizeIs(14));
  EXPECT_EQ(titles[0], "duet: mixes");
  EXPECT_EQ(titles[2], "duet: mixes, 0.5 / 0.5, by pair");
  EXPECT_EQ(titles[4], "duet: negatives");
  EXPECT_EQ(titles[5], "duet: reaction");
  EXPECT_EQ(titles[7], "duet+pose: mixes");
  EXPECT_THAT(RowNames(section->at("tables").at(2)), SizeIs(15));
  EXPECT_THAT(RowNames(section->at("tables").at(6)), ElementsAre("kick"));
}

TEST(SampleCommandsTest, ToldApartHasAColumnAFold) {
  const auto section =
      RunCommand(AddToldApartCommand, {"told-apart", "--seeds", "1", "--starts", "none"});
  ASSERT_THAT(section, IsOk());
  const nlohmann::json& table = section->at("tables").at(0);
  EXPECT_EQ(table.at("columns"), nlohmann::json({"s01", "mean", "spread"}));
  ASSERT_THAT(table.at("rows"), SizeIs(1));
  const double accuracy = table["rows"][0].at("values").at(0);
  EXPECT_GE(accuracy, 0);
  EXPECT_LE(accuracy, 1);
}

}  // namespace
}  // namespace duet::evaluation::program
