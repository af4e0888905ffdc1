#include <gtest/gtest.h>

#include "model/evaluation/report/data_tables.h"
#include "tests/evaluation/support/made_up_pairs.h"

namespace duet::evaluation::report {
namespace {

using test::MadeUpPairs;

TableRow Row(const Table& table, const std::string& name) {
  for (const TableRow& row : table.rows) {
    if (row.name == name) return row;
  }
  ADD_FAILURE() << "no " << name;
  return {"", std::vector<double>(table.columns.size())};
}

TEST(CleanUpTableTest, HasARowForEachStageAndNoneMovesCaptures) {
  const Table table = CleanUpTable(MadeUpPairs(2));
  ASSERT_EQ(table.columns.size(), 5u);
  EXPECT_EQ(table.rows.size(), 12u);
  const TableRow captured = Row(table, "captured");
  for (int column = 0; column < 3; ++column) EXPECT_EQ(captured.values[column], 0) << column;
}

TEST(CleanUpTableTest, OnlyTheFloorStageLowersAFloatingFollower) {
  dataset::Dataset dataset = MadeUpPairs(1);
  for (dataset::Sequence& sequence : dataset.sequences) {
    for (motion::Vec3& joint : sequence.pair.follower.poses.all()) joint.y += 0.5f;
  }
  const Table table = CleanUpTable(dataset);
  EXPECT_EQ(Row(table, "floor").values[0], 100);
  EXPECT_NEAR(Row(table, "floor").values[1], 47, 2);
  EXPECT_GT(Row(table, "all").values[1], 40);
  EXPECT_LT(Row(table, "footsteps").values[1], 2);
}

TEST(CleanUpTableTest, AKneeThatBendsForwardsCountsAsOutOfRange) {
  dataset::Dataset dataset = MadeUpPairs(1);
  const double before = Row(CleanUpTable(dataset), "joint ranges").values[0];
  const motion::JointPair hips = *dataset.skeleton.hips;
  motion::Poses& follower = dataset.sequences[0].pair.follower.poses;
  for (int t = 0; t < follower.frame_count(); ++t) {
    const motion::Vec3 across = follower.at(t, hips.left) - follower.at(t, hips.right);
    const motion::Vec3 forwards = Cross(across, {0, 1, 0}) / Norm(across);
    follower.at(t, dataset.skeleton.feet->left) += forwards * 0.3f;
  }
  EXPECT_GT(Row(CleanUpTable(dataset), "joint ranges").values[0], before + 10);
}

TEST(CleanUpTableTest, NoSequencesNoRows) {
  EXPECT_TRUE(CleanUpTable(dataset::Dataset()).rows.empty());
}

}  // namespace
}  // namespace duet::evaluation::report
