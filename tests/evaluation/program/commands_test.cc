// The commands on made-up captures, with the checkpoint inside the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "model/evaluation/program/experiment.h"
#include "tests/evaluation/support/made_up_captures.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/evaluation/support/run_command.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::program {
namespace {

using test::RowNames;

absl::StatusOr<nlohmann::json> Measured(std::vector<std::string> words) {
  const dataset::CaptureFolder captures;
  test::WriteSwayingCaptures(captures);
  words.insert(words.end(), {"--data", captures.path().string(), "--embedded"});
  return test::RunForSection(std::move(words));
}

TEST(CommandsTest, FoldsHasATableAMetricAndARowAMethod) {
  const auto section = Measured({"folds", "--subjects", "s01", "--starts", "none,root", "--metrics",
                                 "afd,accuracy,fid", "--baselines", "hmm"});
  ASSERT_THAT(section, IsOk());
  EXPECT_EQ(section->at("id"), "10_folds");
  const nlohmann::json& tables = section->at("tables");
  ASSERT_THAT(tables, SizeIs(3));
  EXPECT_THAT(RowNames(tables.at(0)), ElementsAre("hmm", "duet", "duet+root"));
  EXPECT_THAT(RowNames(tables.at(1)), ElementsAre("hmm", "duet", "duet+root", "captured"));
  EXPECT_EQ(section->at("settings").at(0).at("value"), "sbu, 12 sequences");
}

TEST(CommandsTest, SamplesHasARowAStart) {
  const auto section =
      Measured({"samples", "--subjects", "s01", "--samples", "2", "--starts", "none,pose"});
  ASSERT_THAT(section, IsOk());
  const nlohmann::json& table = section->at("tables").at(0);
  EXPECT_THAT(RowNames(table), ElementsAre("captured", "other people", "duet", "duet+pose"));
  EXPECT_EQ(table["rows"][0]["values"][0], 1);          // the speed ratio of the captured
  EXPECT_NEAR(table["rows"][0]["values"][3], 0, 1e-4);  // and their FID
  EXPECT_GT(table["rows"][2]["values"][7], 0);          // answers with two seeds differ
  EXPECT_EQ(section->at("command"),
            "duet-eval samples --data FOLDER --subjects s01 --embedded --starts none,pose "
            "--samples 2 --out FOLDER");
}

TEST(CommandsTest, MixesHasTwoTablesAStart) {
  const auto section =
      Measured({"mixes", "--subjects", "s01", "--leaders", "1", "--starts", "none,pose"});
  ASSERT_THAT(section, IsOk());
  std::vector<std::string> titles;
  for (const nlohmann::json& table : section->at("tables")) titles.push_back(table.at("title"));
  EXPECT_THAT(titles,
              ElementsAre("duet: mixes", "duet: mixes of contact with other classes",
                          "duet+pose: mixes", "duet+pose: mixes of contact with other classes"));
}

TEST(CommandsTest, ToldApartHasAColumnAFold) {
  const auto section =
      Measured({"told-apart", "--subjects", "s01", "--seeds", "1", "--starts", "none"});
  ASSERT_THAT(section, IsOk());
  const nlohmann::json& table = section->at("tables").at(0);
  EXPECT_EQ(table.at("columns"), nlohmann::json({"s01", "mean", "spread"}));
  ASSERT_THAT(table.at("rows"), SizeIs(1));
  const double accuracy = table["rows"][0].at("values").at(0);
  EXPECT_GE(accuracy, 0);
  EXPECT_LE(accuracy, 1);
}

TEST(CommandsTest, AugmentationHasARowAKindOfTrainingData) {
  const auto section =
      Measured({"augmentation", "--seeds", "1,2", "--epochs", "1", "--match", "1", "--mix", "1"});
  ASSERT_THAT(section, IsOk());
  EXPECT_THAT(RowNames(section->at("tables").at(0)),
              ElementsAre("captured", "captured + 1 match + 1 mix", "synthetic alone"));
  EXPECT_THAT(RowNames(section->at("tables").at(1)), SizeIs(4));
}

TEST(PlanSyntheticSetTest, AsksForMatchesAndMixesOfEveryClassByLeadersOfTheHalf) {
  const dataset::Dataset dataset = test::MadeUpPairs(5);
  const auto plan = [&](uint64_t seed) {
    return PlanSyntheticSet(dataset, {0, 1, 2, 5, 6, 7}, 6, 4, seed);
  };
  std::map<int, int> matches, mixes;
  for (const SyntheticJob& job : plan(3)) {
    const int own = job.sequence.interaction_class;
    const float weight = job.labels[static_cast<size_t>(own)],
                other = job.labels[static_cast<size_t>(1 - own)];
    ++(other == 0 ? matches : mixes)[own];
    EXPECT_GE(weight, 0.75f);
    EXPECT_LE(weight, other == 0 ? 1.25f : 1.0f);
    EXPECT_TRUE(other == 0 || (other >= 0.1f && other <= 0.35f));
    EXPECT_TRUE(job.sequence.pair.follower.poses.empty());
    EXPECT_THAT(job.sequence.id.substr(2), testing::AnyOf("0", "1", "2"));
  }
  EXPECT_EQ(matches, (std::map<int, int>{{0, 6}, {1, 6}}));
  EXPECT_EQ(mixes, (std::map<int, int>{{0, 4}, {1, 4}}));
  EXPECT_EQ(plan(3)[5].labels, plan(3)[5].labels);
  EXPECT_NE(plan(3)[5].labels, plan(4)[5].labels);
}

}  // namespace
}  // namespace duet::evaluation::program
