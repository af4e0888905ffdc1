#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/authoring/made_leaders.h"
#include "model/evaluation/program/experiment.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::program {
namespace {

using motion::Poses;
using motion::Vec3;

constexpr double kRate = 15;
constexpr Vec3 kAway = {0, 0, -1};

std::vector<double> Estimated(const std::vector<int>& leaders, const std::vector<double>& values) {
  const Estimate estimate = EstimateMean(leaders, values);
  return {estimate.mean, estimate.low, estimate.high};
}

TEST(EstimateTest, IntervalSpansTheLeadersAndNotTheirRows) {
  EXPECT_THAT(Estimated({0, 1}, {1, 3}), ElementsAre(2, 1, 3));
  EXPECT_THAT(Estimated({0, 0, 0, 1, 1, 1}, {1, 1, 1, 3, 3, 3}), ElementsAre(2, 1, 3));
  EXPECT_THAT(Estimated({0, 1, 2}, {NAN, 5, 5}), ElementsAre(5, 5, 5));
}

Poses Leader() { return authoring::MakeLeader("idle", 2, kRate); }

// Faces the leader from 1.2 m in front, and goes back by `metres` over the clip.
Poses Follower(double metres = 0) {
  Poses poses = Leader();
  for (int t = 0; t < poses.frame_count(); ++t) {
    const float back = static_cast<float>(metres * t / (poses.frame_count() - 1));
    for (Vec3& joint : poses[t]) joint = {-joint.x, joint.y, -1.2f - back - joint.z};
  }
  return poses;
}

double Feature(const std::string& name, const Poses& follower) {
  const std::vector<std::string> names = MeetingFeatures();
  const auto found = std::find(names.begin(), names.end(), name);
  EXPECT_NE(found, names.end()) << name;
  dataset::Sequence sequence;
  sequence.pair.leader.frame_rate_hz = kRate;
  sequence.pair.leader.poses = Leader();
  sequence.pair.follower.poses = Follower();
  return MeasureMeeting(motion::SbuSkeleton(), sequence,
                        follower)[static_cast<size_t>(found - names.begin())];
}

TEST(MeetingGeometryTest, FeaturesGrowWithWhatTheyName) {
  const Poses stands = Follower();
  const Poses retreats = Follower(0.4), approaches = Follower(-0.4);
  for (const char* name : {"head recoils", "root recoils", "hips recoil", "head retreats"}) {
    EXPECT_NEAR(Feature(name, retreats) - Feature(name, stands), 0.4, 0.06) << name;
  }
  EXPECT_NEAR(Feature("root approaches", approaches) - Feature("root approaches", stands), 0.4,
              0.06);
  EXPECT_GT(Feature("near", approaches), Feature("near", stands) + 0.3);
  EXPECT_GT(Feature("hands around", approaches), Feature("hands around", stands) + 0.3);
  constexpr int kHand = 8, kRoot = 2, kNeck = 1;
  Poses offers = stands, leans = stands;
  for (int t = 15; t < stands.frame_count(); ++t) {
    offers.at(t, kHand) = offers.at(t, kRoot) - 0.6f * kAway;
    leans.at(t, kNeck) += 0.3f * kAway;
  }
  EXPECT_NEAR(Feature("hand out", offers), 0.6, 0.05);
  EXPECT_GT(Feature("one hand out", offers), Feature("one hand out", stands) + 0.3);
  EXPECT_NEAR(Feature("hands out", offers), Feature("hands out", stands), 0.05);
  EXPECT_GT(Feature("hands meet", offers), Feature("hands meet", stands) + 0.2);
  EXPECT_GT(Feature("leans back", leans), Feature("leans back", stands) + 20);
}

TEST(MeetingGeometryTest, ClassOwnsWhatExceedsTheSpread) {
  const ClassGeometry classes = {{{1, 5}, {3, 5.5}}, {{1, 1}, {1, 1}}};
  EXPECT_EQ(classes.Own(1, 0, 0), 2);
  EXPECT_EQ(classes.Own(0, 1, 0), 0);  // smaller
  EXPECT_EQ(classes.Own(1, 0, 1), 0);  // within the spread
}

TEST(MeetingGeometryTest, MadeUpClassesDifferInTheStepBack) {
  const dataset::Dataset dataset = test::MadeUpPairs(4);
  ASSERT_TRUE(CanMeasureMeeting(dataset.skeleton));
  const ClassGeometry classes = MeasureClasses(dataset, AllSequences(dataset));
  ASSERT_EQ(classes.means.size(), 2u);
  const auto names = MeetingFeatures();
  const auto retreats =
      static_cast<size_t>(std::find(names.begin(), names.end(), "root retreats") - names.begin());
  EXPECT_GT(classes.Own(1, 0, retreats), 0.1);
}

// Class 0 owns feature 0, class 1 feature 1.
const ClassGeometry kTwoClasses = {{{1, 0}, {0, 1}}, {{0.1, 0.1}, {0.1, 0.1}}};

MixedAnswer Mixed(int own, std::vector<double> mixed) {
  const std::vector<double> first = {1, 0}, second = {0, 1};
  MixedAnswer answer{0, 0, own, 1 - own, std::move(mixed)};
  answer.own_alone = own == 0 ? first : second;
  answer.other_alone = own == 0 ? second : first;
  answer.probabilities = {0.3f, 0.2f, 0.5f};
  return answer;
}

TEST(MixesTest, IngredientsAreSharesOfTheSingleAnswers) {
  const struct {
    std::vector<double> mixed;
    double of_first, of_second, both;
  } kCases[] = {{{1, 0}, 1, 0, 0},
                {{0.5, 0.5}, 0.5, 0.5, 0},
                {{0.8, 0.7}, 0.8, 0.7, 1},
                {{5, -5}, 1.5, -0.5, 0},
                {{1, 1}, 1, 1, 1}};
  for (const auto& c : kCases) {
    for (const int own : {0, 1}) {
      const Kept kept = MeasureKept({Mixed(own, c.mixed)}, {kTwoClasses}).front();
      EXPECT_DOUBLE_EQ(own == 0 ? kept.own : kept.other, c.of_first);
      EXPECT_DOUBLE_EQ(own == 0 ? kept.other : kept.own, c.of_second);
      EXPECT_EQ(kept.both(), c.both);
    }
  }
}

TEST(MixesTest, ClassWithoutGeometryInSingleAnswersHasNoShare) {
  MixedAnswer answer = Mixed(0, {0.5, 0.5});
  answer.other_alone = {0, 0.1};  // hardly more of feature 1 than the first class
  const Kept kept = MeasureKept({answer}, {kTwoClasses}).front();
  EXPECT_EQ(kept.own, 0.5);
  EXPECT_TRUE(std::isnan(kept.other) && std::isnan(kept.weaker()) && std::isnan(kept.both()));
}

TEST(MixesTest, DeviationIsMeasuredFromTheAverage) {
  const Poses a = Follower(), b = Follower(0.5), half = Follower(0.25);
  EXPECT_NEAR(Deviation(half, a, b), 0, 1e-5);
  EXPECT_NEAR(Deviation(a, a, b), 1, 1e-5);
  EXPECT_TRUE(std::isnan(Deviation(half, a, a)));
}

TEST(MixesTest, TableHasAFigureAVariant) {
  const report::Table table =
      MixTable("m", {kTwoClasses},
               {{"one label", {Mixed(0, {1, 0})}},
                {"0.5 / 0.5", {Mixed(0, {0.5, 0.5}), Mixed(1, {0.8, 0.7})}}});
  EXPECT_EQ(table.columns.size(), 6u);
  const auto value = [&](const std::string& name, size_t column) {
    for (const report::TableRow& row : table.rows) {
      if (row.name == name) return row.values[column];
    }
    return NAN * 1.0;
  };
  EXPECT_EQ(value("weaker ingredient", 0), 0);
  EXPECT_DOUBLE_EQ(value("weaker ingredient", 3), 0.6);
  EXPECT_EQ(value("both above half", 3), 0.5);
  EXPECT_EQ(value("third class", 3), 1);
}

}  // namespace
}  // namespace duet::evaluation::program
