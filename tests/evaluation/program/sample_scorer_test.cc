#include "model/evaluation/program/sample_scorer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/evaluation/report/sample_tables.h"
#include "tests/evaluation/support/made_up_pairs.h"

namespace duet::evaluation::program {
namespace {

using test::MadeUpPairs;

using ::testing::DoubleNear;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Gt;
using ::testing::SizeIs;

TEST(SampleScorer, ScoresManyAnswersBesideTheCapturedOnes) {
  const dataset::Dataset dataset = MadeUpPairs(6);
  const absl::StatusOr<SampleScorer> scorer = SampleScorer::Create(dataset, {"a"});
  ASSERT_TRUE(scorer.ok()) << scorer.status();
  EXPECT_THAT(scorer->JudgeSettings(), SizeIs(1));
  absl::StatusOr<report::MethodFigures> captured = scorer->ScoreCaptured();
  ASSERT_TRUE(captured.ok()) << captured.status();
  EXPECT_TRUE(captured->captured);
  EXPECT_THAT(captured->by_metric[report::kPooledFrechet], ElementsAre(DoubleNear(0, 1e-6)));
  // Two answers to each: the captured follower moved to either side.
  metrics::SampledMotions answers;
  for (const float by : {-1.28f, 1.28f}) {
    answers.push_back(metrics::CapturedMotions(dataset, scorer->folds()[0].split.test));
    for (metrics::ScoredMotion& motion : answers.back()) {
      for (motion::Vec3& p : motion.follower.all()) p.z += by;
    }
  }
  absl::StatusOr<report::MethodFigures> made = scorer->Score("made", {answers});
  ASSERT_TRUE(made.ok()) << made.status();
  const double unit = std::sqrt(15);
  EXPECT_THAT(made->by_metric["afd"], Each(DoubleNear(unit, 1e-3)));
  EXPECT_THAT(made->by_metric[report::kBestAnswerAfd], Each(DoubleNear(unit, 1e-3)));
  EXPECT_THAT(made->by_metric[report::kMeanAnswerAfd], Each(DoubleNear(0, 1e-3)));
  EXPECT_THAT(made->by_metric[report::kMultimodality], Each(DoubleNear(2 * unit, 1e-3)));
  EXPECT_THAT(made->by_metric[report::kPooledFrechet], ElementsAre(Gt(1e-3)));
  EXPECT_THAT(made->by_metric[report::kFilteredFrechet], ElementsAre(Gt(1e-3)));
  EXPECT_THAT(made->by_metric[report::kDiversity], SizeIs(2));
}

}  // namespace
}  // namespace duet::evaluation::program
