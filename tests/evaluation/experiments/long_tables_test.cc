#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/evaluation/experiments/long_clips.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::experiments {
namespace {

TEST(LongTablesTest, ShowTheWorstOfLeadersAndOfClasses) {
  const std::vector<LongClipRow> rows = {
      {"flow", "idle", 0, {10, 20, 0.1, 0, 1, 0.5, 0.5, 7, 0.01}},
      {"flow", "idle", 1, {5, 4, 0.2, 0, 2, 0.4, 0.6, 6, 0.02}},
      {"flow", "dance", 0, {30, 8, 0.3, 0, 3, 0.6, 0.1, 9, 0.01}}};
  const std::vector<report::Table> tables = LongTables("60 s", {"kick", "hug"}, rows);
  ASSERT_EQ(tables.size(), 3u);
  for (const report::Table& table : tables) EXPECT_THAT(table.title, HasSubstr("60 s"));
  ASSERT_EQ(tables[0].rows.size(), 2u);
  EXPECT_EQ(tables[0].rows[0].name, "flow: idle");
  EXPECT_THAT(tables[0].rows[0].values, ElementsAre(20, 5));
  EXPECT_EQ(tables[0].rows[1].values[0], 30);
  EXPECT_TRUE(std::isnan(tables[0].rows[1].values[1]));
  EXPECT_THAT(tables[1].rows[0].values, ElementsAre(10, 20, 0.2, 0, 2, 7, 0.02, 0.4, 0.5));
  ASSERT_EQ(tables[2].rows.size(), 2u);
  EXPECT_EQ(tables[2].rows[0].name, "flow: kick");
  EXPECT_THAT(tables[2].rows[0].values, ElementsAre(30, 20, 0.3, 0, 3, 9, 0.01, 0.5, 0.1));
}

}  // namespace
}  // namespace duet::evaluation::experiments
