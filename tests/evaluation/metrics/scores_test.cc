#include "model/evaluation/metrics/scores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/motion/coordinates.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::metrics {
namespace {

using test::MadeUpPairs;

// One raw unit off at each of 15 joints.
const double kUnit = std::sqrt(15);

TEST(AfdTest, RawUnitsScaleEachAxis) {
  const motion::Poses truth(1, {{0.3f, 0.4f, 0.5f}});
  const auto off_by = [&](motion::Vec3 d) { return motion::Poses(1, {truth.at(0, 0) + d}); };
  const auto raw = ToRaw(truth);
  EXPECT_NEAR(Afd(ToRaw(off_by({2.56f, 0, 0})), raw), 1, 1e-6);
  EXPECT_NEAR(Afd(ToRaw(off_by({0, 1.92f, 0})), raw), 1, 1e-6);
  EXPECT_NEAR(Afd(ToRaw(off_by({0, 0, 1.28f})), raw), 1, 1e-6);
  EXPECT_NEAR(AfdSquared(ToRaw(off_by({2.56f, 3.84f, 2.56f})), raw), 9, 1e-5);
}

// The paper's pipeline: everything in the raw unit, the leader's torso subtracted, one yaw removed.
TEST(AfdTest, RawUnitsEqualThePapersPipeline) {
  const motion::Coordinates raw_coordinates = {motion::LengthUnit::kSbuNormalised,
                                               motion::UpAxis::kYDown};
  const std::vector<motion::Vec3> truth = {{0.4f, 1.2f, 1.7f}, {0.5f, 0.3f, 1.9f}};
  const std::vector<motion::Vec3> predicted = {{0.6f, 1.1f, 1.6f}, {0.1f, 0.35f, 2.2f}};
  const motion::Vec3 torso = {0.2f, 0.4f, 1.1f};
  const double yaw = 0.7;
  double squared = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    const motion::Vec3 a = RotateY(predicted[i] - torso, yaw), b = RotateY(truth[i] - torso, yaw);
    squared += Dot(a - b, a - b);
  }
  motion::Poses truth_world(2, truth), predicted_world(2, predicted);
  for (motion::Vec3& p : truth_world.all()) p = ToWorld(raw_coordinates, p);
  for (motion::Vec3& p : predicted_world.all()) p = ToWorld(raw_coordinates, p);
  EXPECT_NEAR(Afd(ToRaw(predicted_world), ToRaw(truth_world)), std::sqrt(squared), 1e-5);
}

TEST(WithoutRootTest, IgnoresPlacementButNotPose) {
  const motion::Poses truth(2, {{0, 0, 0}, {1, 1, 1}, {2, 0, 0}, {1, 2, 1}});
  motion::Poses moved = truth;
  for (motion::Vec3& p : moved[0]) p += motion::Vec3{5, 6, 7};
  for (motion::Vec3& p : moved[1]) p += motion::Vec3{-1, 0, 2};
  EXPECT_NEAR(Afd(WithoutRoot(moved, 0), WithoutRoot(truth, 0)), 0, 1e-6);
  moved.at(1, 1) += motion::Vec3{0, 3, 0};
  EXPECT_NEAR(Afd(WithoutRoot(moved, 0), WithoutRoot(truth, 0)), 1.5, 1e-6);
}

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
  for (motion::Vec3& p : moved.follower.all()) p.z += 1.28f;
  const std::map<std::string, double> scores = ScoreMotion(dataset, moved);
  EXPECT_NEAR(scores.at("afd"), kUnit, 1e-4);
  EXPECT_NEAR(scores.at("afd_squared"), 15, 1e-3);
  EXPECT_NEAR(scores.at("afd_m"), 1.28 * kUnit, 1e-4);
  for (const char* aligned : {"root_aligned_afd", "velocity_error"}) {
    EXPECT_NEAR(scores.at(aligned), 0, 1e-4) << aligned;
  }
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
  EXPECT_NEAR(scores.at("afd"), std::sqrt(15 * raw_squared), 1e-4);
  EXPECT_NEAR(scores.at("afd_m"), kUnit, 1e-4);
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

// Answers to every sequence: the captured follower moved along z by so many raw units.
SampledMotions Moved(const dataset::Dataset& dataset, const std::vector<float>& raw_units) {
  SampledMotions samples;
  for (const float by : raw_units) {
    samples.push_back(CapturedMotions(dataset, AllSequences(dataset)));
    for (ScoredMotion& motion : samples.back()) {
      for (motion::Vec3& p : motion.follower.all()) p.z += 1.28f * by;
    }
  }
  return samples;
}

double AfdOf(const dataset::Dataset& dataset, const ScoredMotion& motion) {
  return Afd(ToRaw(motion.follower), ToRaw(SequenceOf(dataset, motion).pair.follower.poses));
}

TEST(SampledScoresTest, MeanAndBestAnswersAreOfEachLeader) {
  const dataset::Dataset dataset = MadeUpPairs(1);
  const std::vector<ScoredMotion> means = MeanAnswers(Moved(dataset, {3, -1, 1}));
  SampledMotions samples = Moved(dataset, {3, 1});
  std::swap(samples[0][1], samples[1][1]);
  const std::vector<ScoredMotion> best = BestAnswers(dataset, samples);
  ASSERT_THAT(means, SizeIs(2));
  ASSERT_THAT(best, SizeIs(2));
  EXPECT_EQ(means[1].sequence, 1);
  for (const ScoredMotion& answer : {means[0], means[1], best[0], best[1]}) {
    EXPECT_NEAR(AfdOf(dataset, answer), kUnit, 1e-4);
  }
}

TEST(SampledScoresTest, MultimodalityIsTheMeanDistanceOfPairs) {
  dataset::Dataset dataset = MadeUpPairs(1);
  dataset.classes.push_back("none");
  // Distances 2, 3 and 1.
  const std::vector<double> by_class = MultimodalityByClass(dataset, Moved(dataset, {0, 2, 3}));
  ASSERT_THAT(by_class, SizeIs(3));
  EXPECT_NEAR(by_class[0], 2 * kUnit, 1e-4);
  EXPECT_NEAR(by_class[1], 2 * kUnit, 1e-4);
  EXPECT_TRUE(std::isnan(by_class[2]));
  EXPECT_EQ(MultimodalityByClass(dataset, Moved(dataset, {5}))[0], 0);
}

TEST(PooledFrechetTest, TakesAllClassesOfAFoldTogether) {
  // One motion of each class: no class has two, both together do.
  const JudgedFold captured = {{0, 1}, {}, {{0, 0}, {2, 0}}};
  const JudgedFold moved = {{0, 1}, {}, {{0, 3}, {2, 3}}};
  const JudgedFold alone = {{0}, {}, {{7, 7}}};
  EXPECT_NEAR(PooledFrechet({moved, alone}, {captured, alone}), 9, 1e-4);
  EXPECT_NEAR(PooledFrechet({moved, captured}, {captured, captured}), 4.5, 1e-4);
  EXPECT_TRUE(std::isnan(PooledFrechet({alone}, {alone})));
}

}  // namespace
}  // namespace duet::evaluation::metrics
