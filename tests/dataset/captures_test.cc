// The real data sets, when DUET_DATA_DIR (or ../shared/data) has them.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/motion/posture.h"
#include "tests/support/data_folder.h"

namespace duet::dataset {
namespace {

std::vector<int> CountByClass(const Dataset& dataset) {
  std::vector<int> count(dataset.classes.size());
  for (const Sequence& one : dataset.sequences) ++count[static_cast<size_t>(one.interaction_class)];
  return count;
}

TEST(CapturesTest, SbuIsWhole) {
  const auto folder = test::FindData("sbu");
  if (!folder) GTEST_SKIP() << test::kNoData;
  const absl::StatusOr<Dataset> dataset = ReadDataset(*folder);
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  EXPECT_EQ(dataset->sequences.size(), 156u);
  EXPECT_EQ(CountByClass(*dataset), (std::vector<int>{31, 33, 14, 17, 31, 30}));
  EXPECT_EQ(dataset->Subjects().size(), 6u);
  EXPECT_EQ(dataset->LongestFrameCount(), 45);
  const absl::StatusOr<Split> split = LeaveSubjectOut(*dataset, "s03");
  ASSERT_TRUE(split.ok()) << split.status();
  EXPECT_EQ(split->test.size(), 81u);
}

// The mean lean of every leader or every follower.
motion::Lean LeanOfAll(const Dataset& dataset, bool leaders, bool as_captured) {
  std::vector<motion::Vec3> directions;
  for (const Sequence& one : dataset.sequences) {
    motion::Poses poses = leaders ? one.pair.leader.poses : one.pair.follower.poses;
    if (as_captured) poses = one.levelling.Invert(std::move(poses));
    const std::vector<motion::Vec3> some = StandingDirections(dataset.skeleton, poses);
    directions.insert(directions.end(), some.begin(), some.end());
  }
  return MeanLean(directions);
}

TEST(CapturesTest, PeopleStandUprightOnceLevelled) {
  for (const char* name : {"sbu", "k3hi"}) {
    const auto folder = test::FindData(name);
    if (!folder) GTEST_SKIP() << test::kNoData;
    const absl::StatusOr<Dataset> dataset = ReadDataset(*folder);
    ASSERT_TRUE(dataset.ok()) << dataset.status();
    for (const bool leaders : {true, false}) {
      EXPECT_GT(LeanOfAll(*dataset, leaders, true).z, 3) << name << leaders;
      EXPECT_LT(std::abs(LeanOfAll(*dataset, leaders, false).x), 1) << name << leaders;
      EXPECT_LT(std::abs(LeanOfAll(*dataset, leaders, false).z), 1) << name << leaders;
    }
  }
}

TEST(CapturesTest, K3hiIsWhole) {
  const auto folder = test::FindData("k3hi");
  if (!folder) GTEST_SKIP() << test::kNoData;
  const absl::StatusOr<Dataset> dataset = ReadDataset(*folder);
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  EXPECT_EQ(dataset->sequences.size(), 284u);
  EXPECT_EQ(CountByClass(*dataset), (std::vector<int>{37, 33, 29, 46, 45, 41, 33, 20}));
  EXPECT_EQ(dataset->LongestFrameCount(), 104);
}

}  // namespace
}  // namespace duet::dataset
