#include "model/evaluation/experiments/label_sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace duet::evaluation::experiments {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::SizeIs;

// A curve of two classes whose raised class has a probability that is a function of its weight.
SweepCurve Curve(int own, int raised, const std::function<double(double)>& probability) {
  SweepCurve curve{own, raised, {}};
  for (const double weight : SweepWeights()) {
    const float p = static_cast<float>(probability(weight));
    std::vector<float> both(2, 1 - p);
    both[static_cast<size_t>(raised)] = p;
    curve.probabilities.push_back(both);
  }
  return curve;
}

double Rising(double weight) { return 0.4 + 0.2 * weight; }
double Falling(double weight) { return 0.4 - 0.2 * weight; }
double Level(double) { return 0.5; }
// Follows the weight only from 0.5 to 1.
double Late(double weight) { return weight < 0.6 ? 0.1 : weight < 0.9 ? 0.3 : 0.6; }

TEST(SweepWeights, RunFromMinusOneToTwoInQuarters) {
  const std::vector<double>& weights = SweepWeights();
  ASSERT_THAT(weights, SizeIs(13));
  EXPECT_EQ(weights.front(), -1);
  EXPECT_EQ(weights[1], -0.75);
  EXPECT_EQ(weights.back(), 2);
}

TEST(SweepLabels, OwnClassAloneOrBesideAnother) {
  EXPECT_THAT(SweepLabels(3, 1, 1, -0.5), ElementsAre(0, -0.5f, 0));
  EXPECT_THAT(SweepLabels(3, 1, 2, 0.25), ElementsAre(0, 1, 0.25f));
}

TEST(MeasureControl, OfACurveThatFollowsItsWeight) {
  const LabelControl control = MeasureControl({Curve(0, 0, Rising)});
  EXPECT_EQ(control.raised_up, 1);
  EXPECT_EQ(control.lowered_down, 1);
  EXPECT_EQ(control.steps_up, 1);
  EXPECT_EQ(control.raised_level + control.lowered_level + control.steps_level, 0);
  EXPECT_NEAR(control.rank_correlation, 1, 1e-12);
}

TEST(MeasureControl, OfACurveThatGoesTheWrongWay) {
  const LabelControl control = MeasureControl({Curve(0, 0, Falling)});
  EXPECT_EQ(control.raised_up + control.lowered_down + control.steps_up, 0);
  EXPECT_EQ(control.raised_level + control.lowered_level + control.steps_level, 0);
  EXPECT_NEAR(control.rank_correlation, -1, 1e-12);
}

TEST(MeasureControl, CountsLevelApart) {
  const LabelControl control = MeasureControl({Curve(0, 0, Level)});
  EXPECT_EQ(control.raised_up + control.lowered_down + control.steps_up, 0);
  EXPECT_EQ(control.raised_level, 1);
  EXPECT_EQ(control.lowered_level, 1);
  EXPECT_EQ(control.steps_level, 1);
  EXPECT_EQ(control.rank_correlation, 0);
  const auto barely = [](double weight) { return 0.5 + 0.0009 * weight; };
  EXPECT_EQ(MeasureControl({Curve(0, 0, barely)}).raised_level, 1);
}

TEST(MeasureControl, AveragesCurvesAndSteps) {
  const LabelControl control = MeasureControl({Curve(0, 0, Late), Curve(0, 0, Rising)});
  EXPECT_EQ(control.raised_up, 1);
  EXPECT_EQ(control.lowered_down, 0.5);
  EXPECT_EQ(control.lowered_level, 0.5);
  EXPECT_EQ(control.steps_up, (0.5 + 1) / 2);  // two of Late's four
  EXPECT_EQ(control.steps_level, 0.25);
  EXPECT_TRUE(std::isnan(MeasureControl({}).raised_up));
}

TEST(RankCorrelation, SharesTheRanksOfTies) {
  // Ranks 1 2 3 4 and 1 2.5 2.5 4: 4.5 / sqrt(5 * 4.5).
  EXPECT_NEAR(RankCorrelation({1, 2, 3, 4}, {10, 20, 20, 99}), 4.5 / std::sqrt(22.5), 1e-12);
  EXPECT_NEAR(RankCorrelation({1, 2, 3}, {3, 1, 2}), -0.5, 1e-12);
  EXPECT_EQ(RankCorrelation({1, 2, 3}, {7, 7, 7}), 0);
}

TEST(ControlTable, HasARowForEachRaisedClass) {
  const std::vector<SweepCurve> curves = {Curve(0, 0, Rising), Curve(1, 1, Falling),
                                          Curve(1, 0, Falling)};
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
  const std::vector<SweepCurve> curves = {Curve(0, 0, Rising), Curve(0, 0, Level),
                                          Curve(1, 0, Falling)};
  const report::LinePlot plot = SweepPlot("t", {"a", "b"}, curves, SweepKind::kOwn, 0);
  ASSERT_THAT(plot.series, SizeIs(2));
  EXPECT_EQ(plot.series[0].name, "a");
  EXPECT_THAT(plot.series[0].points.back(), ElementsAre(2, DoubleNear((0.8 + 0.5) / 2, 1e-6)));
  EXPECT_THAT(plot.series[1].points.back(), ElementsAre(2, DoubleNear((0.2 + 0.5) / 2, 1e-6)));
}

TEST(SweepPlot, DrawsTheAddedClassForEachOwnOne) {
  const std::vector<SweepCurve> curves = {Curve(0, 0, Level), Curve(1, 0, Falling)};
  const report::LinePlot plot = SweepPlot("t", {"a", "b"}, curves, SweepKind::kAdded, 0);
  ASSERT_THAT(plot.series, SizeIs(1));
  EXPECT_EQ(plot.series[0].name, "beside b");
  EXPECT_THAT(plot.series[0].points.front(), ElementsAre(-1, DoubleNear(0.6, 1e-6)));
}

}  // namespace
}  // namespace duet::evaluation::experiments
