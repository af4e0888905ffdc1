#include <gtest/gtest.h>

#include <cmath>

#include "model/evaluation/metrics/judged_scores.h"
#include "model/evaluation/metrics/scores.h"
#include "tests/evaluation/support/made_up_pairs.h"

namespace duet::evaluation::metrics {
namespace {

using test::MadeUpPairs;

// Answers to every sequence: the captured follower moved along z by so many raw units.
SampledMotions Moved(const dataset::Dataset& dataset, const std::vector<float>& raw_units) {
  std::vector<int> all;
  for (size_t i = 0; i < dataset.sequences.size(); ++i) all.push_back(static_cast<int>(i));
  SampledMotions samples;
  for (const float by : raw_units) {
    samples.push_back(CapturedMotions(dataset, all));
    for (ScoredMotion& motion : samples.back()) {
      for (motion::Vec3& p : motion.follower.all()) p.z += 1.28f * by;
    }
  }
  return samples;
}

double AfdOf(const dataset::Dataset& dataset, const ScoredMotion& motion) {
  const auto& sequence = dataset.sequences[static_cast<size_t>(motion.sequence)];
  return Afd(motion.follower, sequence.pair.follower.poses, MetricUnit::kSbuRaw);
}

// One raw unit off at each of 15 joints.
const double kUnit = std::sqrt(15);

TEST(SampledScoresTest, TheMeanAnswerIsNearerThanItsAnswers) {
  const dataset::Dataset dataset = MadeUpPairs(1);
  const std::vector<ScoredMotion> means = MeanAnswers(Moved(dataset, {3, -1, 1}));
  ASSERT_EQ(means.size(), 2u);
  EXPECT_EQ(means[1].sequence, 1);
  EXPECT_NEAR(AfdOf(dataset, means[0]), kUnit, 1e-4);
  EXPECT_NEAR(AfdOf(dataset, means[1]), kUnit, 1e-4);
}

TEST(SampledScoresTest, TheBestAnswerIsChosenForEachLeader) {
  const dataset::Dataset dataset = MadeUpPairs(1);
  SampledMotions samples = Moved(dataset, {3, 1});
  std::swap(samples[0][1], samples[1][1]);
  const std::vector<ScoredMotion> best = BestAnswers(dataset, samples);
  ASSERT_EQ(best.size(), 2u);
  EXPECT_NEAR(AfdOf(dataset, best[0]), kUnit, 1e-4);
  EXPECT_NEAR(AfdOf(dataset, best[1]), kUnit, 1e-4);
}

TEST(SampledScoresTest, MultimodalityIsTheMeanDistanceOfPairs) {
  dataset::Dataset dataset = MadeUpPairs(1);
  dataset.classes.push_back("none");
  // Distances 2, 3 and 1.
  const std::vector<double> by_class = MultimodalityByClass(dataset, Moved(dataset, {0, 2, 3}));
  ASSERT_EQ(by_class.size(), 3u);
  EXPECT_NEAR(by_class[0], 2 * kUnit, 1e-4);
  EXPECT_NEAR(by_class[1], 2 * kUnit, 1e-4);
  EXPECT_TRUE(std::isnan(by_class[2]));
  EXPECT_EQ(MultimodalityByClass(dataset, Moved(dataset, {5}))[0], 0);
}

TEST(SampledScoresTest, PoolKeepsEveryAnswer) {
  const dataset::Dataset dataset = MadeUpPairs(2);
  EXPECT_EQ(Pool(Moved(dataset, {0, 1, 2})).size(), 12u);
}

TEST(PooledFrechetTest, TakesAllClassesOfAFoldTogether) {
  // One motion of each class: no class has two, both together do.
  const JudgedFold captured = {{0, 1}, {}, {{0, 0}, {2, 0}}};
  const JudgedFold moved = {{0, 1}, {}, {{0, 3}, {2, 3}}};
  const JudgedFold alone = {{0}, {}, {{7, 7}}};
  absl::StatusOr<double> distance = PooledFrechet({moved, alone}, {captured, alone});
  ASSERT_TRUE(distance.ok()) << distance.status();
  EXPECT_NEAR(*distance, 9, 1e-4);
  EXPECT_NEAR(*PooledFrechet({moved, captured}, {captured, captured}), 4.5, 1e-4);
  EXPECT_TRUE(std::isnan(*PooledFrechet({alone}, {alone})));
}

}  // namespace
}  // namespace duet::evaluation::metrics
