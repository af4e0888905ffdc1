// The command with the checkpoint inside the program, for a few seconds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "model/motion/skeleton.h"
#include "tests/evaluation/support/run_command.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/temporary_folder.h"

namespace duet::evaluation::program {
namespace {

// Writes a leader who walks, with the joints of SBU, as a motion file.
void WriteWalker(const std::filesystem::path& file) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const motion::Poses poses = test::SwayingMotion(40, 15);
  nlohmann::json frames = nlohmann::json::array();
  for (int t = 0; t < poses.frame_count(); ++t) {
    nlohmann::json& frame = frames.emplace_back(nlohmann::json::array());
    for (const motion::Vec3& p : poses[t]) frame.push_back({p.x, p.y, p.z});
  }
  test::WriteTestFile(file, nlohmann::json{{"format", "duet-motion"},
                                           {"version", 1},
                                           {"frame_rate_hz", 15},
                                           {"unit", "metres"},
                                           {"up_axis", "y-up"},
                                           {"joint_names", skeleton.joint_names},
                                           {"leader", frames}}
                                .dump());
}

TEST(PlausibleCommandTest, MeasuresStillnessWithoutAndWithEachClassInClipsAndLive) {
  const test::TemporaryFolder leaders;
  WriteWalker(leaders / "walker.json");
  const auto section = test::RunForSection(
      {"plausible", "--leaders", leaders.path().string(), "--seconds", "4", "--embedded"});
  ASSERT_THAT(section, IsOk());
  const nlohmann::json& figures = section->at("tables").at(0);
  EXPECT_EQ(figures.at("title"), "duet: followers of 5 leaders");
  const nlohmann::json& table = section->at("tables").at(1);
  EXPECT_EQ(table.at("title"), "duet: followers of 5 leaders who do not move");
  EXPECT_EQ(table.at("columns"), nlohmann::json({"speed", "hand up", "feet apart", "hips"}));
  const std::vector<std::string> names = test::RowNames(table);
  ASSERT_EQ(names.size(), 2 * 7u);
  EXPECT_EQ(names[0], "weights 0");
  EXPECT_EQ(names[1], "kick");
  EXPECT_EQ(names[7], "weights 0, live");
  EXPECT_EQ(names[13], "punch, live");
  for (const nlohmann::json& row : table.at("rows")) {
    EXPECT_GT(row.at("values").at(0), 0) << row;
    EXPECT_GT(row.at("values").at(2), 0) << row;
    EXPECT_GT(row.at("values").at(3), 0.5) << row;
  }
}

TEST(PlausibleCommandTest, MeasuresEachAnswerAndTheNetworksOwn) {
  const test::TemporaryFolder leaders;
  WriteWalker(leaders / "walker.json");
  const auto measure = [&](const std::string& flag) {
    return test::RunForSection({"plausible", "--leaders", leaders.path().string(), "--seconds", "4",
                                "--embedded", "--each", flag});
  };
  const auto served = measure("--as-served"), own = measure("--own");
  ASSERT_THAT(served, IsOk());
  ASSERT_THAT(own, IsOk());
  const nlohmann::json& answers = served->at("tables").at(2);
  EXPECT_EQ(answers.at("rows").size(), 5 * 6u);
  EXPECT_THAT(test::RowNames(answers)[0], testing::StartsWith("kick walker.json "));
  EXPECT_THAT(test::RowNames(served->at("tables").at(1)),
              testing::Contains("hug, live, walker.json"));
  EXPECT_NE(answers, own->at("tables").at(2));
}

}  // namespace
}  // namespace duet::evaluation::program
