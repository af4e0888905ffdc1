// The commands of sampled answers on made-up captures, with the checkpoint inside the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "model/evaluation/program/commands.h"
#include "model/evaluation/report/result_section.h"
#include "model/motion/coordinates.h"
#include "tests/dataset/capture_folder.h"
#include "tests/support/sample_motion.h"
#include "tests/support/status_matchers.h"

namespace duet::evaluation::program {
namespace {

using test::IsOk;
using test::TemporaryFolder;

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::vector<motion::Vec3> AsCaptured(std::vector<motion::Vec3> pose, motion::Vec3 at, double yaw) {
  for (motion::Vec3& p : pose) {
    p = FromWorld({motion::LengthUnit::kSbuNormalised, motion::UpAxis::kYDown},
                  RotateY(p, yaw) + at);
  }
  return pose;
}

// Two people who sway towards each other, each in a rhythm of the clip's own.
std::string Capture(double rhythm) {
  std::string text;
  for (int t = 0; t < 24; ++t) {
    const double seconds = rhythm * t / 15;
    text += dataset::CaptureLine(t + 1, AsCaptured(test::SwayingPose(seconds), {-1, 0, 0}, 1.6),
                                 AsCaptured(test::SwayingPose(2 * seconds), {1, 0, 1}, -1.6));
  }
  return text;
}

// A clip of every class by two pairs of people.
void WriteCaptures(const dataset::CaptureFolder& folder) {
  double rhythm = 1;
  for (const char* people : {"s01s02", "s03s04"}) {
    for (const char* interaction_class : {"03", "04", "05", "06", "07", "08"}) {
      folder.Write(std::string(people) + "/" + interaction_class + "/001/skeleton_pos.txt",
                   Capture(rhythm += 0.1));
    }
  }
}

// What the command leaves in its folder of results.
absl::StatusOr<report::ResultSection> RunCommand(std::vector<std::string> words) {
  const dataset::CaptureFolder captures;
  WriteCaptures(captures);
  const TemporaryFolder folder;
  words.insert(words.end(), {"--data", captures.path().string(), "--embedded", "--subjects", "s01",
                             "--out", folder.path().string()});
  CLI::App app;
  ChosenCommand chosen;
  AddSamplesCommand(&app, &chosen);
  AddLongCommand(&app, &chosen);
  AddStripsCommand(&app, &chosen);
  AddToldApartCommand(&app, &chosen);
  std::reverse(words.begin(), words.end());  // as CLI11 wants them
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    return absl::InvalidArgumentError(error.what());
  }
  absl::Status status = chosen();
  if (!status.ok()) return status;
  absl::StatusOr<std::vector<report::ResultSection>> sections = report::ReadSections(folder.path());
  if (!sections.ok()) return sections.status();
  return sections->front();
}

std::vector<std::string> RowNames(const report::Table& table) {
  std::vector<std::string> names;
  for (const report::TableRow& row : table.rows) names.push_back(row.name);
  return names;
}

TEST(SampleCommandsTest, SamplesHasARowAStart) {
  const auto section = RunCommand({"samples", "--samples", "2", "--starts", "none,pose"});
  ASSERT_THAT(section, IsOk());
  EXPECT_EQ(section->id, "14_samples");
  EXPECT_THAT(RowNames(section->tables.at(0)),
              ElementsAre("captured", "other people", "duet", "duet+pose"));
  EXPECT_THAT(section->command, HasSubstr("--embedded --starts none,pose --subjects s01"));
}

TEST(SampleCommandsTest, LongHasARowALeader) {
  const auto section = RunCommand({"long", "--seconds", "5", "--starts", "pose"});
  ASSERT_THAT(section, IsOk());
  ASSERT_THAT(section->tables, SizeIs(3));
  EXPECT_THAT(RowNames(section->tables[0]),
              ElementsAre("people: clips as captured", "duet: idle", "duet: walk_eight",
                          "duet: dance", "duet: sit", "duet: captured"));
  EXPECT_THAT(section->tables[2].rows, SizeIs(2 * 6));
}

TEST(SampleCommandsTest, ToldApartHasAColumnAFold) {
  const auto section = RunCommand({"told-apart", "--seeds", "1", "--starts", "none"});
  ASSERT_THAT(section, IsOk());
  EXPECT_THAT(section->tables.at(0).columns, ElementsAre("s01", "mean", "spread"));
  ASSERT_THAT(section->tables[0].rows, SizeIs(1));
  EXPECT_GE(section->tables[0].rows[0].values[0], 0);
  EXPECT_LE(section->tables[0].rows[0].values[0], 1);
}

TEST(SampleCommandsTest, StripsDrawsEveryClassTwice) {
  const auto section = RunCommand({"strips", "--start", "pose"});
  ASSERT_THAT(section, IsOk());
  ASSERT_THAT(section->figures, SizeIs(12));
  EXPECT_EQ(section->figures[0].name, "18_strips_kick");
  EXPECT_THAT(section->figures[0].caption, HasSubstr("s01s02/03/001"));
  EXPECT_THAT(section->figures[0].svg, HasSubstr(">duet</text>"));
  EXPECT_EQ(section->figures[1].name, "18_strips_kick_moving");
  EXPECT_THAT(section->figures[1].svg, HasSubstr("<animate "));
}

}  // namespace
}  // namespace duet::evaluation::program
