// The standardisation against the one sequence that the paper's authors published in the form they
// fed to their network.

#include <cmath>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_split.h"
#include "gtest/gtest.h"
#include "model/motion/standardise.h"
#include "tests/support/data_folder.h"
#include "tests/support/temporary_folder.h"

namespace duet::motion {
namespace {

using test::FindData;
using test::kNoData;
using test::ReadTestFile;

constexpr std::size_t kJoints = 15;
constexpr std::size_t kFrames = 17;

std::vector<Vec3> ToPositions(const std::vector<float>& values, std::size_t from) {
  std::vector<Vec3> positions;
  for (std::size_t i = from; i + 2 < from + 3 * kJoints; i += 3) {
    positions.push_back({values[i], values[i + 1], values[i + 2]});
  }
  return positions;
}

// Every line's numbers.
std::vector<std::vector<float>> ReadTable(const std::filesystem::path& path) {
  std::vector<std::vector<float>> table;
  for (absl::string_view line : absl::StrSplit(ReadTestFile(path), '\n', absl::SkipWhitespace())) {
    std::vector<float>& row = table.emplace_back();
    for (absl::string_view cell :
         absl::StrSplit(line, absl::ByAnyChar(", \r"), absl::SkipEmpty())) {
      EXPECT_TRUE(absl::SimpleAtof(cell, &row.emplace_back())) << cell;
    }
  }
  return table;
}

TEST(PublishedSample, EqualsOursInTheReleasedCodesDirection) {
  const auto sample_path = FindData("imm_sample/2A_SBUIMM1sh_3");
  const auto capture_path = FindData("sbu/s01s02/03/001/skeleton_pos.txt");
  if (!sample_path || !capture_path) GTEST_SKIP() << kNoData;

  // The person on the right of the image, in the data set's raw unit, as theirs is.
  Poses leader(0, kJoints);
  for (const std::vector<float>& row : ReadTable(*capture_path)) {
    ASSERT_EQ(row.size(), 1 + 2 * 3 * kJoints);
    leader.Append(ToPositions(row, 1 + 3 * kJoints));
  }
  ASSERT_EQ(leader.frame_count(), static_cast<int>(kFrames));
  const Standardisation standardisation(SbuSkeleton(), leader, YawDirection::kAsReleasedCode);
  const Poses ours = standardisation.Apply(leader);

  const std::vector<std::vector<float>> sample = ReadTable(*sample_path);
  ASSERT_EQ(sample.size(), 46u);
  for (std::size_t frame = 0; frame < sample.size(); ++frame) {
    ASSERT_EQ(sample[frame].size(), 3 * kJoints);
    const std::vector<Vec3> theirs = ToPositions(sample[frame], 0);
    for (std::size_t j = 0; j < kJoints; ++j) {
      const Vec3 wanted = frame < kFrames ? ours.all()[frame * kJoints + j] : Vec3{};
      EXPECT_LT(Distance(theirs[j], wanted), 2e-6f) << "frame " << frame << ", joint " << j;
    }
  }
  EXPECT_NEAR(standardisation.yaw() * 180 / M_PI, 81.7213, 1e-3);
}

TEST(PublishedSample, OursTurnsTheRightWay) {
  const auto capture_path = FindData("sbu/s01s02/03/001/skeleton_pos.txt");
  if (!capture_path) GTEST_SKIP() << kNoData;
  const Poses pose(kJoints, ToPositions(ReadTable(*capture_path)[0], 1 + 3 * kJoints));
  const Poses ours = Standardisation(SbuSkeleton(), pose).Apply(pose);
  const Vec3 across = ours.at(0, 12) - ours.at(0, 9);
  EXPECT_NEAR(std::atan2(across.z, across.x) * 180 / M_PI, 0, 1e-4);
}

}  // namespace
}  // namespace duet::motion
