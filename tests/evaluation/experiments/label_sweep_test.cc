#include "model/evaluation/experiments/label_sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/evaluation/support/sweep_curve.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::experiments {
namespace {

using test::MakeSweepCurve;

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
  const LabelControl control = MeasureControl({MakeSweepCurve(0, 0, Rising)});
  EXPECT_EQ(control.raised_up, 1);
  EXPECT_EQ(control.lowered_down, 1);
  EXPECT_EQ(control.steps_up, 1);
  EXPECT_EQ(control.raised_level + control.lowered_level + control.steps_level, 0);
  EXPECT_NEAR(control.rank_correlation, 1, 1e-12);
}

TEST(MeasureControl, OfACurveThatGoesTheWrongWay) {
  const LabelControl control = MeasureControl({MakeSweepCurve(0, 0, Falling)});
  EXPECT_EQ(control.raised_up + control.lowered_down + control.steps_up, 0);
  EXPECT_EQ(control.raised_level + control.lowered_level + control.steps_level, 0);
  EXPECT_NEAR(control.rank_correlation, -1, 1e-12);
}

TEST(MeasureControl, CountsLevelSeparately) {
  const LabelControl control = MeasureControl({MakeSweepCurve(0, 0, Level)});
  EXPECT_EQ(control.raised_up + control.lowered_down + control.steps_up, 0);
  EXPECT_EQ(control.raised_level, 1);
  EXPECT_EQ(control.lowered_level, 1);
  EXPECT_EQ(control.steps_level, 1);
  EXPECT_EQ(control.rank_correlation, 0);
  const auto barely = [](double weight) { return 0.5 + 0.0009 * weight; };
  EXPECT_EQ(MeasureControl({MakeSweepCurve(0, 0, barely)}).raised_level, 1);
}

TEST(MeasureControl, AveragesCurvesAndSteps) {
  const LabelControl control =
      MeasureControl({MakeSweepCurve(0, 0, Late), MakeSweepCurve(0, 0, Rising)});
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

TEST(SelectCurves, ByKindAndClass) {
  const std::vector<SweepCurve> curves = {
      MakeSweepCurve(0, 0, Rising), MakeSweepCurve(1, 0, Rising), MakeSweepCurve(1, 1, Rising),
      MakeSweepCurve(0, 1, Rising)};
  const auto own = Select(curves, SweepKind::kOwn, 0), added = Select(curves, SweepKind::kAdded, 0);
  ASSERT_THAT(own, SizeIs(1));
  EXPECT_EQ(own[0].own, 0);
  ASSERT_THAT(added, SizeIs(1));
  EXPECT_EQ(added[0].own, 1);
}

TEST(MeanProbabilities, AreOfOneClassOverAllCurves) {
  const std::vector<double> means =
      MeanProbabilities({MakeSweepCurve(0, 0, Rising), MakeSweepCurve(0, 0, Level)}, 0);
  ASSERT_THAT(means, SizeIs(SweepWeights().size()));
  EXPECT_NEAR(means.back(), (0.8 + 0.5) / 2, 1e-6);
  EXPECT_NEAR(MeanProbabilities({MakeSweepCurve(0, 0, Rising)}, 1).back(), 0.2, 1e-6);
}

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

TEST(ProbabilityTable, HasTheMeanOfEachRaisedClassByItsWeight) {
  const std::vector<SweepCurve> curves = {MakeSweepCurve(0, 0, Rising), MakeSweepCurve(0, 0, Level),
                                          MakeSweepCurve(1, 0, Falling)};
  const report::Table own = ProbabilityTable("t", {"a", "b"}, curves, SweepKind::kOwn);
  ASSERT_THAT(own.columns, SizeIs(SweepWeights().size()));
  EXPECT_EQ(own.columns.front(), "-1");
  EXPECT_NEAR(own.rows[0].values.back(), (0.8 + 0.5) / 2, 1e-6);
  EXPECT_TRUE(std::isnan(own.rows[1].values.back()));
  const report::Table added = ProbabilityTable("t", {"a", "b"}, curves, SweepKind::kAdded);
  EXPECT_NEAR(added.rows[0].values.front(), 0.6, 1e-6);
}

TEST(AddSweep, AddsTwoTablesAKind) {
  report::ResultSection section;
  AddSweep({"a", "b"}, {MakeSweepCurve(0, 0, Level), MakeSweepCurve(1, 0, Falling)},
           "given the first root", &section);
  ASSERT_THAT(section.tables, SizeIs(4));
  EXPECT_EQ(section.tables[0].title, "Own class alone, given the first root");
  EXPECT_EQ(section.tables[3].title,
            "Another class beside the own one, given the first root: probabilities");
}

}  // namespace
}  // namespace duet::evaluation::experiments
