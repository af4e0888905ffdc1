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

TEST(CapturesTest, SbuFollowersStandWhereTheirDirectionPoints) {
  const auto folder = test::FindData("sbu");
  if (!folder) GTEST_SKIP() << test::kNoData;
  const absl::StatusOr<Dataset> dataset = ReadDataset(*folder);
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  const int root = dataset->skeleton.root;
  for (const Sequence& one : dataset->sequences) {
    ASSERT_TRUE(one.partner_direction.has_value());
    const motion::Vec3 across = one.pair.follower.at(0, root) - one.pair.leader.at(0, root);
    // Within 45 degrees of it, or the axis is not the setup's.
    EXPECT_GT(Dot(across, *one.partner_direction), 0.7f * std::hypot(across.x, across.z)) << one.id;
  }
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

TEST(CapturesTest, SetsStandUprightOnceLevelled) {
  const auto folder = test::FindData("sbu");
  if (!folder) GTEST_SKIP() << test::kNoData;
  const absl::StatusOr<Dataset> dataset = ReadDataset(*folder);
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  std::map<std::string, std::vector<motion::Vec3>> directions, feet;
  for (const Sequence& one : dataset->sequences) {
    for (const motion::Clip* clip : {&one.pair.leader, &one.pair.follower}) {
      for (const motion::Vec3& d : StandingDirections(dataset->skeleton, clip->poses)) {
        directions[one.set].push_back(d);
      }
      for (const motion::Vec3& f : LowerFeet(dataset->skeleton, clip->poses)) {
        feet[one.set].push_back(f);
      }
    }
  }
  ASSERT_EQ(directions.size(), 17u);
  for (const auto& [set, of_set] : directions) {
    // What is left is what these people do, which the set's vertical is not to follow to the end.
    EXPECT_LT(std::abs(MeanLean(of_set).z), 1.5) << set;
    EXPECT_LT(std::abs(MeanLean(of_set).x), 1.5) << set;
    EXPECT_NEAR(HeightQuantile(feet[set], 0.25), 0, 0.001) << set;
  }
}

TEST(CapturesTest, TheMotionRuleAgreesWithTheIndexOnSbu) {
  const auto folder = test::FindData("sbu");
  if (!folder) GTEST_SKIP() << test::kNoData;
  const absl::StatusOr<Dataset> dataset = ReadDataset(*folder);
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  int agreed = 0, asked = 0;
  for (const Sequence& one : dataset->sequences) {
    if (dataset->symmetric[static_cast<size_t>(one.interaction_class)]) continue;
    ++asked;
    ASSERT_TRUE(one.rule_agrees.has_value()) << one.id;
    if (*one.rule_agrees) ++agreed;
  }
  EXPECT_EQ(asked, 94);
  EXPECT_GE(agreed, 80);
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
