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

TEST(SolverTableTest, CapturesAreUnmovedAndSolvedOnesHardlySlide) {
  const Table table = SolverTable(MadeUpPairs(2));
  ASSERT_EQ(table.columns.size(), 5u);
  ASSERT_EQ(table.rows.size(), 2u);
  const TableRow captured = Row(table, "captured"), solved = Row(table, "solved");
  for (int column = 0; column < 3; ++column) EXPECT_EQ(captured.values[column], 0) << column;
  EXPECT_GT(solved.values[1], 0);
}

TEST(SolverTableTest, AFloatingFollowerComesDown) {
  dataset::Dataset dataset = MadeUpPairs(1);
  const double before = Row(SolverTable(dataset), "solved").values[1];
  for (dataset::Sequence& sequence : dataset.sequences) {
    for (motion::Vec3& joint : sequence.pair.follower.poses.all()) joint.y += 0.5f;
  }
  EXPECT_GT(Row(SolverTable(dataset), "solved").values[1], before + 25);
}

TEST(SolverTableTest, NoSequencesNoRows) {
  EXPECT_TRUE(SolverTable(dataset::Dataset()).rows.empty());
}

}  // namespace
}  // namespace duet::evaluation::report
