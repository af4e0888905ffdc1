// The commands of sampled answers on made-up captures, with the checkpoint inside the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "model/checkpoint/checkpoint.h"
#include "model/motion/skeleton.h"
#include "tests/evaluation/support/made_up_captures.h"
#include "tests/evaluation/support/read_section.h"
#include "tests/evaluation/support/run_command.h"
#include "tests/support/architectures.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_checkpoint.h"

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
  ASSERT_THAT(titles, SizeIs(16));
  EXPECT_EQ(titles[0], "duet: mixes");
  EXPECT_EQ(titles[2], "duet: mixes, 0.5 / 0.5, by pair");
  EXPECT_EQ(titles[4], "duet: negatives");
  EXPECT_EQ(titles[6], "duet: reaction");
  EXPECT_EQ(titles[8], "duet+pose: mixes");
  EXPECT_THAT(RowNames(section->at("tables").at(2)), SizeIs(15));
  EXPECT_THAT(RowNames(section->at("tables").at(7)), ElementsAre("kick"));
}

TEST(SampleCommandsTest, MixesMeasuresOnlyWhatIsAsked) {
  const auto section = RunCommand(
      AddMixesCommand, {"mixes", "--leaders", "1", "--starts", "none", "--measures", "reaction"});
  ASSERT_THAT(section, IsOk());
  EXPECT_THAT(section->at("tables"), SizeIs(2));
}

TEST(SampleCommandsTest, DanceComparesWithBaselinesAndAnotherLead) {
  const auto section = RunCommand(AddDanceCommand, {"dance", "--samples", "1"});
  ASSERT_THAT(section, IsOk());
  const nlohmann::json& table = section->at("tables").at(0);
  EXPECT_THAT(RowNames(table), ElementsAre("first pose held", "class mean", "nearest seconds",
                                           "captured", "duet+pose", "duet+pose, other lead"));
  ASSERT_EQ(table.at("columns").at(0), "error");
  EXPECT_EQ(table["rows"][3].at("values").at(0), 0);
  EXPECT_GT(table["rows"][4].at("values").at(0), 0);
}

TEST(SampleCommandsTest, DanceLoopsLeadersAndWeighsTurns) {
  const auto section = RunCommand(
      AddDanceCommand, {"dance", "--samples", "1", "--loop-minutes", "1.5", "--turn-class", "hug"});
  ASSERT_THAT(section, IsOk());
  const nlohmann::json& tables = section->at("tables");
  ASSERT_THAT(tables, SizeIs(4));
  EXPECT_EQ(tables[1].at("columns").at(1), "5 to 10 s");
  EXPECT_THAT(RowNames(tables[1]), ElementsAre("duet+pose"));
  EXPECT_THAT(RowNames(tables[2]),
              ElementsAre("duet+pose, first minute", "duet+pose, from the second loop",
                          "duet+pose, last minute"));
  EXPECT_TRUE(tables[2]["rows"][0].at("values").at(0).is_null());  // no captured follower
  EXPECT_GT(tables[2]["rows"][2].at("values").at(1), 0);
  EXPECT_EQ(tables[3].at("columns"), nlohmann::json({"-1", "-0.5", "0", "0.5", "1"}));
  EXPECT_THAT(RowNames(tables[3]), ElementsAre("duet+pose, not led", "duet+pose, led"));
}

TEST(SampleCommandsTest, DanceNeedsAMinuteAfterTheFirstLoop) {
  EXPECT_THAT(RunCommand(AddDanceCommand, {"dance", "--samples", "1", "--loop-minutes", "1"}),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("--loop-minutes: expected at least 1.0")));
}

// A checkpoint of the captures' people and classes that samples, with weights by a rule.
void WriteSampler(const std::filesystem::path& folder) {
  checkpoint::Manifest manifest = test::TinyManifest();
  manifest.model.skeleton = motion::SbuSkeleton();
  manifest.model.classes = {"kick", "push", "shake_hands", "hug", "exchange_object", "punch"};
  manifest.model.frame_rate_hz = 15;
  manifest.parts = motion::SbuParts();
  manifest.architecture = test::SmallFlow();
  manifest.training["flow.noise_share"] = "0.5";
  ASSERT_THAT(WriteCheckpoint(folder, test::FilledCheckpoint(std::move(manifest))), IsOk());
}

TEST(SampleCommandsTest, DanceMeasuresACheckpointWithoutItsParts) {
  const test::TemporaryFolder folder;
  const std::filesystem::path checkpoint = folder.path() / "1";
  WriteSampler(checkpoint);
  const dataset::CaptureFolder captures;
  test::WriteSwayingCaptures(captures);
  const auto section =
      test::RunForSection(AddDanceCommand, {"dance", "--samples", "2", "--ablations", "--data",
                                            captures.path().string(), "--checkpoint",
                                            checkpoint.string(), "--subjects", "s01"});
  ASSERT_THAT(section, IsOk());
  const nlohmann::json& table = section->at("tables").back();
  std::vector<std::string> names;
  for (const char* name :
       {"as served", "no clean-up", "four candidates", "all the noise of training"}) {
    names.insert(names.end(), {name, std::string(name) + ", deviation"});
  }
  EXPECT_THAT(RowNames(table), testing::ElementsAreArray(names));
  const auto error = [&](std::size_t row) { return table["rows"][row].at("values").at(0); };
  EXPECT_GT(error(0), 0);
  EXPECT_GT(error(1), 0);         // two seeds differ
  EXPECT_NE(error(2), error(0));  // without clean-up
  EXPECT_NE(error(6), error(0));  // with more noise
}

TEST(SampleCommandsTest, AblationsNeedACheckpoint) {
  EXPECT_THAT(RunCommand(AddDanceCommand, {"dance", "--samples", "1", "--ablations"}),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("--ablations: expected --checkpoint, got none")));
}

TEST(SampleCommandsTest, DanceRejectsATurnThatTheDataLacks) {
  const auto section =
      RunCommand(AddDanceCommand, {"dance", "--samples", "1", "--turn-class", "pirouette"});
  EXPECT_THAT(section, StatusIs(absl::StatusCode::kInvalidArgument,
                                HasSubstr("--turn-class: expected a class of the data")));
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

TEST(SampleCommandsTest, ToldApartFinishesCapturedFollowersIfAsked) {
  const auto section = RunCommand(
      AddToldApartCommand,
      {"told-apart", "--seeds", "1", "--starts", "none", "--as-served", "--finish-captured"});
  ASSERT_THAT(section, IsOk());
  EXPECT_THAT(section->at("settings").dump(), HasSubstr("finished as answers"));
}

}  // namespace
}  // namespace duet::evaluation::program
