#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "model/evaluation/program/experiment.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::program {
namespace {

double Rising(double weight) { return 0.4 + 0.2 * weight; }
double Falling(double weight) { return 0.4 - 0.2 * weight; }
double Level(double) { return 0.5; }
double Barely(double weight) { return 0.5 + 0.0009 * weight; }

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

TEST(SweepTables, MeasureWhetherTheProbabilityFollowsTheWeight) {
  const struct {
    std::vector<std::function<double(double)>> curves;
    std::vector<double> control;  // up, level, down, level
  } kCases[] = {{{Rising}, {1, 0, 1, 0}},
                {{Falling}, {0, 0, 0, 0}},
                {{Level}, {0, 1, 0, 1}},
                {{Barely}, {0, 1, 0, 1}},
                {{Level, Rising}, {0.5, 0.5, 0.5, 0.5}}};
  for (const auto& c : kCases) {
    std::vector<SweepCurve> curves;
    for (const auto& probability : c.curves) curves.push_back(Curve(0, 0, probability));
    EXPECT_EQ(SweepTables("m", {"a", "b"}, curves)[0].rows[0].values, c.control);
  }
}

TEST(SweepTables, AreTwoForTheOwnClassAndTwoForAnotherBesideIt) {
  const std::vector<report::Table> tables = SweepTables(
      "m", {"a", "b"},
      {Curve(0, 0, Rising), Curve(0, 0, Level), Curve(1, 1, Falling), Curve(1, 0, Falling)});
  ASSERT_THAT(tables, SizeIs(4));
  EXPECT_EQ(tables[0].title, "m: own class alone");
  EXPECT_EQ(tables[3].title, "m: another class beside the own one: probabilities");
  ASSERT_THAT(tables[0].rows, SizeIs(3));
  EXPECT_EQ(tables[0].rows[2].name, "all");
  EXPECT_NEAR(tables[0].rows[2].values.front(), 1.0 / 3, 1e-9);
  ASSERT_THAT(tables[2].rows, SizeIs(2));  // nothing was added to b
  EXPECT_EQ(tables[1].columns.front(), "-1");
  EXPECT_EQ(tables[1].columns.size(), 13u);
  EXPECT_NEAR(tables[1].rows[0].values.back(), (0.8 + 0.5) / 2, 1e-6);
  EXPECT_NEAR(tables[3].rows[0].values.front(), 0.6, 1e-6);
}

}  // namespace
}  // namespace duet::evaluation::program
