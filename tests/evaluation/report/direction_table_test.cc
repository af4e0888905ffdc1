#include "model/evaluation/report/direction_table.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/matchers.h"

namespace duet::evaluation::report {
namespace {

TEST(DirectionTable, HasMediansAndPercentilesBetweenNeighbours) {
  const Table table = DirectionTable({{"hips", {40, 10, 30, 20}}, {"one", {7}}, {"none", {}}});
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(table.rows[0].name, "hips");
  EXPECT_THAT(table.columns, ElementsAre("tests", "median", "90th percentile"));
  EXPECT_THAT(table.rows[0].values, ElementsAre(4, DoubleEq(25), DoubleEq(37)));
  EXPECT_THAT(table.rows[1].values, ElementsAre(1, 7, 7));
  EXPECT_EQ(table.rows[2].values[0], 0);
  EXPECT_TRUE(std::isnan(table.rows[2].values[1]));
}

}  // namespace
}  // namespace duet::evaluation::report
