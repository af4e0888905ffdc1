#include "model/evaluation/experiments/label_sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/matchers.h"

namespace duet::evaluation::experiments {
namespace {

double Rising(double weight) { return 0.4 + 0.2 * weight; }
double Falling(double weight) { return 0.4 - 0.2 * weight; }
double Level(double) { return 0.5; }
double Barely(double weight) { return 0.5 + 0.0009 * weight; }
// Follows the weight only from 0.5 to 1.
double Late(double weight) { return weight < 0.6 ? 0.1 : weight < 0.9 ? 0.3 : 0.6; }

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

std::vector<report::Table> Swept(const std::vector<SweepCurve>& curves) {
  report::ResultSection section;
  AddSweep({"a", "b"}, curves, "given the first root", &section);
  return section.tables;
}

TEST(SweepWeights, RunFromMinusOneToTwoInQuarters) {
  ASSERT_THAT(SweepWeights(), SizeIs(13));
  EXPECT_EQ(SweepWeights().front(), -1);
  EXPECT_EQ(SweepWeights()[1], -0.75);
  EXPECT_EQ(SweepWeights().back(), 2);
}

// up, level, down, level, steps up, steps level, rank correlation
TEST(AddSweep, MeasuresWhetherTheProbabilityFollowsTheWeight) {
  const struct {
    std::vector<std::function<double(double)>> curves;
    std::vector<double> control;
  } kCases[] = {{{Rising}, {1, 0, 1, 0, 1, 0, 1}},
                {{Falling}, {0, 0, 0, 0, 0, 0, -1}},
                {{Level}, {0, 1, 0, 1, 0, 1, 0}},
                {{Barely}, {0, 1, 0, 1, 0, 1, 1}},
                // Two of Late's four steps rise. Its ranks: 7 ties of 4, one of 8, 5 ties of 11.
                {{Late, Rising}, {1, 0, 0.5, 0.5, 0.75, 0.25, 0.94}}};
  for (const auto& c : kCases) {
    std::vector<SweepCurve> curves;
    for (const auto& probability : c.curves) curves.push_back(Curve(0, 0, probability));
    EXPECT_THAT(Swept(curves)[0].rows[0].values, Pointwise(DoubleNear(0.01), c.control));
  }
}

TEST(AddSweep, HasTwoTablesForTheOwnClassAndTwoForAnotherBesideIt) {
  const std::vector<report::Table> tables =
      Swept({Curve(0, 0, Rising), Curve(0, 0, Level), Curve(1, 1, Falling), Curve(1, 0, Falling)});
  ASSERT_THAT(tables, SizeIs(4));
  EXPECT_EQ(tables[0].title, "Own class alone, given the first root");
  EXPECT_EQ(tables[3].title,
            "Another class beside the own one, given the first root: probabilities");
  ASSERT_THAT(tables[0].rows, SizeIs(3));
  EXPECT_EQ(tables[0].rows[0].values.front(), 0.5);
  EXPECT_EQ(tables[0].rows[1].values.front(), 0);
  EXPECT_EQ(tables[0].rows[2].name, "all");
  EXPECT_NEAR(tables[0].rows[2].values.front(), 1.0 / 3, 1e-9);
  EXPECT_EQ(tables[2].rows[0].values.front(), 0);
  EXPECT_TRUE(std::isnan(tables[2].rows[1].values.front()));
  EXPECT_EQ(tables[1].columns.front(), "-1");
  EXPECT_NEAR(tables[1].rows[0].values.back(), (0.8 + 0.5) / 2, 1e-6);
  EXPECT_NEAR(tables[3].rows[0].values.front(), 0.6, 1e-6);
  EXPECT_TRUE(std::isnan(tables[3].rows[1].values.back()));
}

}  // namespace
}  // namespace duet::evaluation::experiments
