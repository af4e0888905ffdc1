#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "model/checkpoint/checkpoint.h"
#include "tests/evaluation/support/made_up_captures.h"
#include "tests/evaluation/support/read_section.h"
#include "tests/evaluation/support/run_command.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::evaluation::program {
namespace {

using test::TemporaryFolder;
using test::TinyManifest;

// A capture of each class of two people who stand still.
void WriteCaptures(const dataset::CaptureFolder& folder) {
  const std::vector<motion::Vec3> pose = test::SwayingPose(0);
  std::string text;
  for (int t = 1; t <= 12; ++t) {
    text += dataset::CaptureLine(t, test::AsCaptured(pose, {-1, 0, 0}, -1.6),
                                 test::AsCaptured(pose, {1, 0, 0}, 1.6));
  }
  for (const char* interaction_class : test::kSbuClassFolders) {
    folder.Write("s01s02/" + std::string(interaction_class) + "/001/skeleton_pos.txt", text);
  }
}

// A run as duet-train leaves it.
void WriteRun(const std::filesystem::path& run, checkpoint::Manifest manifest) {
  const std::filesystem::path folder = run / "checkpoint" / manifest.model.name / "3";
  std::filesystem::create_directories(folder.parent_path());
  ASSERT_THAT(WriteCheckpoint(folder, test::FilledCheckpoint(std::move(manifest))), IsOk());
}

checkpoint::Manifest SbuManifest() {
  checkpoint::Manifest manifest = TinyManifest();
  manifest.model.skeleton = motion::SbuSkeleton();
  manifest.parts = motion::SbuParts();
  return manifest;
}

// Expects partners a constant angle off the hips.
checkpoint::Manifest ConstantManifest(double cosine, double sine) {
  checkpoint::Manifest manifest = SbuManifest();
  std::vector<double> none(33, 0);
  engine::AngleRegression& constant = manifest.model.partner_direction.emplace();
  constant = {none, std::vector<double>(33, 1), none, none};
  constant.cosine.back() = cosine;
  constant.sine.back() = sine;
  return manifest;
}

absl::StatusOr<nlohmann::json> RunCommand(const std::vector<std::string>& runs) {
  const dataset::CaptureFolder captures;
  WriteCaptures(captures);
  std::vector<std::string> words = {"direction", "--data", captures.path().string(), "--subjects",
                                    "s01"};
  for (const std::string& one : runs) words.insert(words.end(), {"--runs", one});
  const auto section = test::RunForSection(AddDirectionCommand, std::move(words));
  if (!section.ok()) return section.status();
  EXPECT_EQ(section->at("id"), "06_direction");
  return section->at("tables").at(0);
}

TEST(DirectionCommandTest, HasARowForTheHipsAndForEachRun) {
  const TemporaryFolder folder;
  WriteRun(folder.path() / "ahead/s01", ConstantManifest(1, 0));
  WriteRun(folder.path() / "behind/s01", ConstantManifest(-1, 0));
  WriteRun(folder.path() / "old/s01", SbuManifest());
  const auto table =
      RunCommand({"ahead=" + (folder / "ahead").string(), "behind=" + (folder / "behind").string(),
                  "old=" + (folder / "old").string()});
  ASSERT_THAT(table, IsOk());
  EXPECT_THAT(test::RowNames(*table), testing::ElementsAre("hips", "ahead", "behind", "old"));
  const auto value = [&](size_t row, size_t column) {
    return table->at("rows").at(row).at("values").at(column).get<double>();
  };
  EXPECT_EQ(value(0, 0), 6);
  const double hips = value(0, 1);
  EXPECT_LT(hips, 90);
  EXPECT_NEAR(value(1, 1), hips, 0.01);
  EXPECT_NEAR(value(2, 1), 180 - hips, 0.01);
  EXPECT_EQ(table->at("rows").at(3).at("values"), table->at("rows").at(0).at("values"));
}

TEST(DirectionCommandTest, NamesARunThatIsMissingOrOfOtherJoints) {
  const TemporaryFolder folder;
  EXPECT_THAT(RunCommand({"x=" + (folder / "nowhere").string()}),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("nowhere/s01")));
  WriteRun(folder.path() / "tiny/s01", TinyManifest());
  EXPECT_THAT(RunCommand({"x=" + (folder / "tiny").string()}),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("tiny/s01: expected the data set's 15 joints, got 3")));
}

}  // namespace
}  // namespace duet::evaluation::program
