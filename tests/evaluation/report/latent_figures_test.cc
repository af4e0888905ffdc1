#include "model/evaluation/report/latent_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace duet::evaluation::report {
namespace {

using testing::ElementsAre;

TEST(LatentTableTest, HasAColumnForEachFigureOfAMap) {
  EXPECT_THAT(LatentTable().columns,
              ElementsAre("1 in the map", "1 in the space", "5 in the space"));
  const TableRow row = LatentRow("ours", {{}, 0.25, 0.5, 0.75});
  EXPECT_EQ(row.name, "ours");
  EXPECT_THAT(row.values, ElementsAre(0.25, 0.5, 0.75));
}

TEST(PlotByClassTest, PutsEveryPointInTheSeriesOfItsClass) {
  const ScatterPlot plot =
      PlotByClass("map", {"kick", "push", "hug"}, {{1, 2}, {3, 4}, {5, 6}}, {2, 0, 2});
  ASSERT_EQ(plot.series.size(), 3u);
  EXPECT_EQ(plot.series[0].points, (std::vector<metrics::Point2>{{3, 4}}));
  EXPECT_EQ(plot.series[1].name, "push");
  EXPECT_TRUE(plot.series[1].points.empty());
  EXPECT_EQ(plot.series[2].points, (std::vector<metrics::Point2>{{1, 2}, {5, 6}}));
}

}  // namespace
}  // namespace duet::evaluation::report
