#include "model/evaluation/report/data_tables.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/evaluation/support/made_up_pairs.h"

namespace duet::evaluation::report {
namespace {

using test::MadeUpPairs;

// Two sets; the second was captured by a tilted camera and is level now.
dataset::Dataset TwoSets() {
  dataset::Dataset dataset = MadeUpPairs(2);
  const auto tilt = static_cast<float>(std::tan(10 * M_PI / 180));
  for (size_t i = 0; i < dataset.sequences.size(); ++i) {
    dataset.sequences[i].set = i < 2 ? "one" : "two";
    if (i >= 2) dataset.sequences[i].levelling = motion::Levelling({0, 1, tilt}, 0.5f);
  }
  return dataset;
}

double Cell(const Table& table, const std::string& row, const std::string& column) {
  for (const TableRow& one : table.rows) {
    for (size_t c = 0; one.name == row && c < table.columns.size(); ++c) {
      if (table.columns[c] == column) return one.values[c];
    }
  }
  ADD_FAILURE() << "no " << row << ", " << column;
  return 0;
}

TEST(DataTablesTest, LeanIsShownAsCapturedAndLevel) {
  const Table table = LeanTable(TwoSets());
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(table.rows.back().name, "all");
  EXPECT_EQ(Cell(table, "two", "sequences"), 2);
  EXPECT_EQ(Cell(table, "one", "leader z"), Cell(table, "one", "level leader z"));
  EXPECT_NEAR(Cell(table, "two", "leader z") - Cell(table, "two", "level leader z"), 10, 0.2);
  EXPECT_NEAR(Cell(table, "two", "follower z") - Cell(table, "two", "level follower z"), 10, 0.2);
  EXPECT_NEAR(Cell(table, "two", "leader x"), Cell(table, "two", "level leader x"), 0.2);
}

TEST(DataTablesTest, FloorIsShownAsCapturedAndLevel) {
  const Table table = FloorTable(TwoSets());
  EXPECT_NEAR(Cell(table, "two", "lean z") - Cell(table, "two", "level lean z"), 10, 1);
  EXPECT_GT(Cell(table, "two", "height cm") - Cell(table, "two", "level height cm"), 30);
  EXPECT_EQ(Cell(table, "one", "height cm"), Cell(table, "one", "level height cm"));
}

TEST(DataTablesTest, ASetWithoutNameIsAll) { EXPECT_EQ(LeanTable(MadeUpPairs(1)).rows.size(), 1u); }

TEST(DataTablesTest, RepairedJointsAreCounted) {
  dataset::Dataset dataset = MadeUpPairs(1);
  motion::Clip& leader = dataset.sequences[0].pair.leader;
  leader.at(8, 0).y += 1;
  const Table table = NoiseTable(dataset);
  EXPECT_EQ(Cell(table, "give", "repaired"), 1);
  EXPECT_EQ(Cell(table, "flinch", "repaired"), 0);
  EXPECT_EQ(Cell(table, "give", "joint frames"), 2 * 15 * leader.frame_count());
  EXPECT_LT(Cell(table, "give", "jitter repaired"), Cell(table, "give", "jitter"));
  EXPECT_LT(Cell(table, "give", "jitter smooth"), Cell(table, "give", "jitter repaired"));
}

TEST(DataTablesTest, LeadersAreCountedBySource) {
  dataset::Dataset dataset = MadeUpPairs(3);
  dataset.symmetric[1] = true;
  for (size_t i = 0; i < 3; ++i) dataset.sequences[i].leader_source = "index";
  dataset.sequences[0].rule_agrees = true;
  dataset.sequences[1].rule_agrees = false;
  dataset.sequences[3].leader_source = "guess";
  dataset.sequences[3].rule_agrees = true;
  dataset.sequences[4].leader_source = "motion";
  const Table table = LeaderTable(dataset);
  EXPECT_EQ(Cell(table, "give", "by index"), 3);
  EXPECT_EQ(Cell(table, "give", "rule agrees"), 0.5);  // the third was never asked
  EXPECT_EQ(Cell(table, "flinch (either)", "by its guess"), 1);
  EXPECT_EQ(Cell(table, "flinch (either)", "by motion"), 1);
  EXPECT_TRUE(std::isnan(Cell(table, "flinch (either)", "rule agrees")));
  EXPECT_EQ(Cell(table, "all", "sequences"), 6);
}

}  // namespace
}  // namespace duet::evaluation::report
