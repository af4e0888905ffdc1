#include "model/dataset/lone_leaders.h"

#include <gmock/gmock.h>

#include <string>

#include "model/motion/skeleton.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/temporary_folder.h"

namespace duet::dataset {
namespace {

using test::TemporaryFolder;
using test::WriteTestFile;

// A motion at 30 Hz as a JSON file.
std::string JsonMotion(int frames) {
  std::string names, rows;
  for (const std::string& name : motion::SbuSkeleton().joint_names) {
    names += (names.empty() ? "\"" : ", \"") + name + "\"";
  }
  const motion::Poses poses = test::SwayingMotion(frames, 30);
  for (int t = 0; t < frames; ++t) {
    rows += t == 0 ? "[" : ", [";
    for (int j = 0; j < poses.joint_count(); ++j) {
      const motion::Vec3 p = poses.at(t, j);
      rows += (j == 0 ? "[" : ", [") + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " +
              std::to_string(p.z) + "]";
    }
    rows += "]";
  }
  return R"({"format": "duet-motion", "version": 1, "frame_rate_hz": 30, "unit": "metres", )"
         R"("up_axis": "y-up", "joint_names": [)" +
         names + "], \"leader\": [" + rows + "]}";
}

class LoneLeadersTest : public ::testing::Test {
 protected:
  void Write(const std::string& name, const std::string& content) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    WriteTestFile(folder_ / name, content);
  }
  absl::StatusOr<std::vector<LoneLeader>> Read() {
    return ReadLoneLeaders(folder_.path(), motion::SbuSkeleton(), 15);
  }

  TemporaryFolder folder_;
};

TEST_F(LoneLeadersTest, ReadsEveryMotionBelowTheFolderAtTheRateOfTheData) {
  Write("turns.json", JsonMotion(61));
  Write("more/walks.json", JsonMotion(31));
  Write("notes.md", "Not a motion.");
  const auto leaders = Read();
  ASSERT_THAT(leaders, IsOk());
  ASSERT_EQ(leaders->size(), 2u);
  EXPECT_EQ((*leaders)[0].id, "more/walks.json");
  EXPECT_EQ((*leaders)[1].id, "turns.json");
  EXPECT_EQ((*leaders)[1].poses.frame_count(), 31);
  const motion::Poses expected = test::SwayingMotion(31, 15);
  for (int j = 0; j < 15; ++j) {
    EXPECT_LT(Distance((*leaders)[1].poses.at(20, j), expected.at(20, j)), 1e-4f) << j;
  }
}

TEST_F(LoneLeadersTest, AFileThatIsNoMotionIsNamed) {
  Write("a.json", JsonMotion(31));
  Write("b.json", "{\"format\": \"duet-motion\"");
  EXPECT_THAT(Read(), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("b.json")));
  Write("b.json", "");
  EXPECT_THAT(Read(), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("b.json")));
  Write("b.json", JsonMotion(1));
  EXPECT_THAT(Read(), StatusIs(absl::StatusCode::kInvalidArgument,
                               HasSubstr("b.json: frames: expected at least 2, got 1")));
}

TEST_F(LoneLeadersTest, DigestDependsOnNamesAndMotions) {
  Write("a.json", JsonMotion(31));
  const auto first = Read(), again = Read();
  ASSERT_THAT(first, IsOk());
  EXPECT_EQ(DigestOf(*first), DigestOf(*again));
  std::vector<LoneLeader> renamed = *first, moved = *first;
  renamed[0].id = "b.json";
  moved[0].poses.at(3, 3).x += 1e-6f;
  EXPECT_NE(DigestOf(*first), DigestOf(renamed));
  EXPECT_NE(DigestOf(*first), DigestOf(moved));
}

}  // namespace
}  // namespace duet::dataset
