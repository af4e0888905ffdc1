// The real data sets, when DUET_DATA_DIR (or ../shared/data) has them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "model/dataset/dataset.h"
#include "model/dataset/leader_side.h"

namespace duet::dataset {
namespace {

std::filesystem::path DataFolder(const std::string& name) {
  if (const char* folder = std::getenv("DUET_DATA_DIR")) {
    return std::filesystem::path(folder) / name;
  }
  const char* source = std::getenv("DUET_SOURCE_DIR");
  return std::filesystem::path(source == nullptr ? "." : source) / "../shared/data" / name;
}

std::vector<int> CountByClass(const Dataset& dataset) {
  std::vector<int> count(dataset.classes.size());
  for (const Sequence& one : dataset.sequences) ++count[static_cast<size_t>(one.interaction_class)];
  return count;
}

TEST(CapturesTest, SbuIsWhole) {
  if (!std::filesystem::exists(DataFolder("sbu"))) GTEST_SKIP() << "no SBU data at hand";
  const absl::StatusOr<Dataset> dataset = ReadDataset(DataFolder("sbu"));
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  EXPECT_EQ(dataset->sequences.size(), 156u);
  EXPECT_EQ(CountByClass(*dataset), (std::vector<int>{31, 33, 14, 17, 31, 30}));
  EXPECT_EQ(dataset->Subjects().size(), 6u);
  EXPECT_EQ(dataset->LongestFrameCount(), 45);
  const absl::StatusOr<Split> split = LeaveSubjectOut(*dataset, "s03");
  ASSERT_TRUE(split.ok()) << split.status();
  EXPECT_EQ(split->test.size(), 81u);
}

TEST(CapturesTest, SbuFollowersStandWhereTheirDirectionPoints) {
  if (!std::filesystem::exists(DataFolder("sbu"))) GTEST_SKIP() << "no SBU data at hand";
  const absl::StatusOr<Dataset> dataset = ReadDataset(DataFolder("sbu"));
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  const int root = dataset->skeleton.root;
  for (const Sequence& one : dataset->sequences) {
    ASSERT_TRUE(one.partner_direction.has_value());
    const motion::Vec3 across = one.pair.follower.at(0, root) - one.pair.leader.at(0, root);
    // Within 45 degrees of it, or the axis is not the setup's.
    EXPECT_GT(Dot(across, *one.partner_direction), 0.7f * std::hypot(across.x, across.z)) << one.id;
  }
}

TEST(CapturesTest, TheMotionRuleAgreesWithTheIndexOnSbu) {
  if (!std::filesystem::exists(DataFolder("sbu"))) GTEST_SKIP() << "no SBU data at hand";
  const absl::StatusOr<Dataset> dataset = ReadDataset(DataFolder("sbu"));
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  int agreed = 0, asked = 0;
  for (const Sequence& one : dataset->sequences) {
    if (dataset->symmetric[static_cast<size_t>(one.interaction_class)]) continue;
    const bool kick = one.interaction_class == 0;
    const std::vector<int> effectors = kick ? std::vector<int>{11, 14} : std::vector<int>{5, 8};
    const LeaderSide side =
        LeaderByMotion(one.pair.leader, one.pair.follower, dataset->skeleton.root, effectors);
    ++asked;
    if (side == LeaderSide::kLeft) ++agreed;
  }
  EXPECT_EQ(asked, 94);
  EXPECT_GE(agreed, 80);
}

TEST(CapturesTest, K3hiIsWhole) {
  if (!std::filesystem::exists(DataFolder("k3hi"))) GTEST_SKIP() << "no K3HI data at hand";
  const absl::StatusOr<Dataset> dataset = ReadDataset(DataFolder("k3hi"));
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  EXPECT_EQ(dataset->sequences.size(), 284u);
  EXPECT_EQ(CountByClass(*dataset), (std::vector<int>{37, 33, 29, 46, 45, 41, 33, 20}));
  EXPECT_EQ(dataset->LongestFrameCount(), 104);
}

}  // namespace
}  // namespace duet::dataset
