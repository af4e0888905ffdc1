#include "model/evaluation/metrics/scores.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "tests/evaluation/support/made_up_pairs.h"

namespace duet::evaluation::metrics {
namespace {

using test::MadeUpPairs;

TEST(ScoresTest, TheCapturedFollowerHasNoErrors) {
  const dataset::Dataset dataset = MadeUpPairs(1);
  const ScoredMotion captured = CapturedMotions(dataset, {0}).front();
  const std::map<std::string, double> scores = ScoreMotion(dataset, captured);
  for (const char* error : {"afd", "afd_squared", "afd_m", "root_aligned_afd", "velocity_error"}) {
    EXPECT_EQ(scores.at(error), 0) << error;
  }
  EXPECT_GT(scores.at("jitter"), 0);
}

TEST(ScoresTest, EachColumnHoldsItsOwnMetric) {
  const dataset::Dataset dataset = MadeUpPairs(1);
  ScoredMotion moved = CapturedMotions(dataset, {0}).front();
  // Everyone 1.28 m along z: one raw unit, for each of 15 joints.
  for (motion::Vec3& p : moved.follower.all()) p.z += 1.28f;
  const std::map<std::string, double> scores = ScoreMotion(dataset, moved);
  EXPECT_NEAR(scores.at("afd"), std::sqrt(15), 1e-4);
  EXPECT_NEAR(scores.at("afd_squared"), 15, 1e-3);
  EXPECT_NEAR(scores.at("afd_m"), 1.28 * std::sqrt(15), 1e-4);
  EXPECT_NEAR(scores.at("afd_squared_m"), 1.28 * 1.28 * 15, 1e-3);
  EXPECT_NEAR(scores.at("root_aligned_afd"), 0, 1e-4);
  EXPECT_NEAR(scores.at("root_aligned_afd_m"), 0, 1e-4);
  EXPECT_NEAR(scores.at("velocity_error"), 0, 1e-4);
}

TEST(ScoresTest, RawUnitIsMeasuredInTheWorldAsCaptured) {
  dataset::Dataset dataset = MadeUpPairs(1);
  // Captured by a camera that is pitched by 45 degrees.
  dataset.sequences[0].levelling = motion::Levelling({0, 1, 1}, 0.5f);
  ScoredMotion moved = CapturedMotions(dataset, {0}).front();
  for (motion::Vec3& p : moved.follower.all()) p.y += 1;
  const std::map<std::string, double> scores = ScoreMotion(dataset, moved);
  // 1 m up is as captured sqrt(1/2) m along y and z, whose raw units are 1.92 m and 1.28 m.
  const double raw_squared = 0.5 / (1.92 * 1.92) + 0.5 / (1.28 * 1.28);
  EXPECT_NEAR(scores.at("afd_squared"), 15 * raw_squared, 1e-4);
  EXPECT_NEAR(scores.at("afd"), std::sqrt(15 * raw_squared), 1e-4);
  EXPECT_NEAR(scores.at("root_aligned_afd"), 0, 1e-4);
  EXPECT_NEAR(scores.at("afd_m"), std::sqrt(15), 1e-4);
}

TEST(ScoresTest, AveragesOverTheMotionsOfAClass) {
  const dataset::Dataset dataset = MadeUpPairs(2);
  std::vector<ScoredMotion> motions = CapturedMotions(dataset, {0, 1});
  for (motion::Vec3& p : motions[1].follower.all()) p.z += 1.28f;
  const auto by_class = ScoreByClass(dataset, motions);
  EXPECT_NEAR(by_class.at("afd_squared")[0], 7.5, 1e-3);
  EXPECT_TRUE(std::isnan(by_class.at("afd_squared")[1]));
}

TEST(ScoresTest, DepthIsAveragedOnlyOverPenetratingMotions) {
  const dataset::Dataset dataset = MadeUpPairs(2);
  std::vector<ScoredMotion> motions = CapturedMotions(dataset, {0, 1});
  const char* const frequency = "penetration_frequency";
  const char* const depth = "penetration_depth_m";
  EXPECT_EQ(ScoreByClass(dataset, motions).at(frequency)[0], 0);
  EXPECT_TRUE(std::isnan(ScoreByClass(dataset, motions).at(depth)[0]));
  // On the leader's very spot: the trunks' capsules overlap by both radii.
  motions[0].follower = dataset.sequences[0].pair.leader.poses;
  EXPECT_NEAR(ScoreByClass(dataset, motions).at(frequency)[0], 0.5, 1e-6);
  EXPECT_NEAR(ScoreByClass(dataset, motions).at(depth)[0], 0.22, 1e-6);
}

TEST(ScoresTest, ClassesAreThoseOfTheSequences) {
  const dataset::Dataset dataset = MadeUpPairs(2);
  const int first = dataset.sequences[0].interaction_class;
  EXPECT_EQ(ClassesOf(dataset, {3, 0}), (std::vector<int>{1 - first, first}));
}

TEST(ScoresTest, CapturedMotionsAnswerTheSameSequences) {
  const dataset::Dataset dataset = MadeUpPairs(2);
  const std::vector<ScoredMotion> captured = CapturedMotions(dataset, {3, 1, 3});
  ASSERT_EQ(captured.size(), 3u);
  EXPECT_EQ(captured[2].sequence, 3);
  EXPECT_EQ(captured[1].follower, dataset.sequences[1].pair.follower.poses);
}

}  // namespace
}  // namespace duet::evaluation::metrics
