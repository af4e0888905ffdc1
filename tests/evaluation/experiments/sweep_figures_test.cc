#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/evaluation/experiments/label_sweep.h"
#include "tests/evaluation/support/sweep_curve.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::experiments {
namespace {

using test::MakeSweepCurve;

double Rising(double weight) { return 0.4 + 0.2 * weight; }
double Falling(double weight) { return 0.4 - 0.2 * weight; }
double Level(double) { return 0.5; }

TEST(ControlTable, HasARowForEachRaisedClass) {
  const std::vector<SweepCurve> curves = {
      MakeSweepCurve(0, 0, Rising), MakeSweepCurve(1, 1, Falling), MakeSweepCurve(1, 0, Falling)};
  const report::Table own = ControlTable("own", {"a", "b"}, curves, SweepKind::kOwn);
  ASSERT_THAT(own.rows, SizeIs(3));
  EXPECT_EQ(own.rows[0].values.front(), 1);
  EXPECT_EQ(own.rows[1].values.front(), 0);
  EXPECT_EQ(own.rows[2].name, "all");
  EXPECT_EQ(own.rows[2].values.front(), 0.5);
  const report::Table added = ControlTable("added", {"a", "b"}, curves, SweepKind::kAdded);
  EXPECT_EQ(added.rows[0].values.front(), 0);
  EXPECT_TRUE(std::isnan(added.rows[1].values.front()));
}

TEST(SweepPlot, DrawsTheMeanOfEveryClassAgainstTheOwnWeight) {
  const std::vector<SweepCurve> curves = {MakeSweepCurve(0, 0, Rising), MakeSweepCurve(0, 0, Level),
                                          MakeSweepCurve(1, 0, Falling)};
  const report::LinePlot plot = SweepPlot("t", {"a", "b"}, curves, SweepKind::kOwn, 0);
  ASSERT_THAT(plot.series, SizeIs(2));
  EXPECT_EQ(plot.series[0].name, "a");
  EXPECT_THAT(plot.series[0].points.back(), ElementsAre(2, DoubleNear((0.8 + 0.5) / 2, 1e-6)));
  EXPECT_THAT(plot.series[1].points.back(), ElementsAre(2, DoubleNear((0.2 + 0.5) / 2, 1e-6)));
}

TEST(SweepPlot, DrawsTheAddedClassForEachOwnOne) {
  const std::vector<SweepCurve> curves = {MakeSweepCurve(0, 0, Level),
                                          MakeSweepCurve(1, 0, Falling)};
  const report::LinePlot plot = SweepPlot("t", {"a", "b"}, curves, SweepKind::kAdded, 0);
  ASSERT_THAT(plot.series, SizeIs(1));
  EXPECT_EQ(plot.series[0].name, "beside b");
  EXPECT_THAT(plot.series[0].points.front(), ElementsAre(-1, DoubleNear(0.6, 1e-6)));
}

TEST(AddSweep, AddsATableAKindAndAFigureAClass) {
  const std::vector<SweepCurve> curves = {MakeSweepCurve(0, 0, Level),
                                          MakeSweepCurve(1, 0, Falling)};
  report::ResultSection section;
  section.id = "30_sweep";
  AddSweep({"a", "b"}, curves, {"given the first root", "_root"}, &section);
  ASSERT_THAT(section.tables, SizeIs(2));
  EXPECT_EQ(section.tables[0].title, "Own class alone, given the first root");
  EXPECT_EQ(section.tables[1].title, "Another class beside the own one, given the first root");
  std::vector<std::string> names;
  for (const report::ResultFigure& figure : section.figures) names.push_back(figure.name);
  EXPECT_THAT(names, ElementsAre("30_sweep_own_a_root", "30_sweep_own_b_root",
                                 "30_sweep_added_a_root", "30_sweep_added_b_root"));
  EXPECT_EQ(std::get<report::LinePlot>(section.figures[0].plot).title,
            "a alone, given the first root");
  EXPECT_THAT(section.figures[0].caption, HasSubstr("the weight of a alone, given the first root"));
  EXPECT_THAT(section.figures[2].caption, HasSubstr("a added, given the first root"));
}

}  // namespace
}  // namespace duet::evaluation::experiments
