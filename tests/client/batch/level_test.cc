#include "client/batch/level.h"

#include "client/batch/leader_source.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/motion_file.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

const motion::Vec3 kUp = {0.05f, 1, 0.17f};

TEST(ParseLevel, AcceptsAVerticalWithin45Degrees) {
  EXPECT_TRUE(ParseLevel("auto")->automatic);
  EXPECT_FALSE(ParseLevel("off")->automatic);
  EXPECT_EQ(ParseLevel("off")->up, std::nullopt);
  EXPECT_EQ(ParseLevel("0,1,0.9")->up, (motion::Vec3{0, 1, 0.9f}));
  for (const char* text : {"", "on", "0,1", "0,0,0", "0,1,1.1", "0,-1,0", "0,nan,0", "0,inf,0"}) {
    EXPECT_THAT(ParseLevel(text), StatusIs(absl::StatusCode::kInvalidArgument,
                                           HasSubstr("expected auto, off or X,Y,Z")))
        << text;
  }
}

// Writes a person in every file, as a tilted camera captures them.
void WriteLeader(const std::filesystem::path& file, const motion::Poses& level) {
  const motion::Clip clip{motion::SbuSkeleton().joint_names, 15, test::Tilted(level, kUp)};
  EXPECT_THAT(formats::WritePair(file, {clip, clip}, motion::SbuSkeleton()), IsOk());
}

motion::VerticalEstimate EstimateFrom(const std::filesystem::path& folder, bool stopped = false) {
  const auto leaders = ListLeaders({folder.string()}, std::nullopt, nullptr);
  EXPECT_THAT(leaders, IsOk());
  return EstimateVertical({}, motion::SbuSkeleton(), leaders->get(), [stopped] { return stopped; });
}

TEST(EstimateVertical, CollectsAllFilesAndSkipsThoseThatCannotBeRead) {
  const test::TemporaryFolder folder;
  WriteLeader(folder / "stands.csv", test::SteppingMotion({}, 45, 15));
  test::WriteTestFile(folder / "broken.csv", "frame\n");
  const Levelled alone = LevelBy(EstimateFrom(folder.path()));
  EXPECT_EQ(alone.up, std::nullopt) << "one place is no evidence";
  EXPECT_THAT(alone.note, StartsWith("not levelled: "));
  WriteLeader(folder / "turns.csv", test::TurningMotion(15));
  const Levelled both = LevelBy(EstimateFrom(folder.path()));
  ASSERT_TRUE(both.up.has_value());
  EXPECT_LT(Distance(*both.up, kUp / Norm(kUp)), 0.03f);
  EXPECT_THAT(both.note, StartsWith("levelled: tilted by "));
}

TEST(EstimateVertical, EndsWhenStopped) {
  const test::TemporaryFolder folder;
  WriteLeader(folder / "turns.csv", test::TurningMotion(15));
  EXPECT_EQ(EstimateFrom(folder.path(), true).verdict, motion::TiltVerdict::kUnknown);
}

}  // namespace
}  // namespace duet::client::batch
