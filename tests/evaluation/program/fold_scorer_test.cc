#include "model/evaluation/program/fold_scorer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/evaluation/report/metric_tables.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::program {
namespace {

using test::MadeUpPairs;

using ::testing::Gt;

OneAnswerEach Captured(const dataset::Dataset& dataset, const FoldScorer& scorer) {
  OneAnswerEach captured;
  for (const Fold& fold : scorer.folds()) {
    captured.push_back(metrics::CapturedMotions(dataset, fold.split.test));
  }
  return captured;
}

TEST(FoldScorer, ScoresPerfectAnswersLikeTheCapturedFollowers) {
  const dataset::Dataset dataset = MadeUpPairs(6);
  const absl::StatusOr<FoldScorer> scorer =
      FoldScorer::Create(dataset, *LeaveOut(dataset, {"a", "b"}), FoldScorer::Judging::kPlain);
  ASSERT_TRUE(scorer.ok()) << scorer.status();
  absl::StatusOr<report::MethodFigures> perfect =
      scorer->Score("perfect", Captured(dataset, *scorer));
  ASSERT_TRUE(perfect.ok()) << perfect.status();
  EXPECT_THAT(perfect->by_metric["afd"], ElementsAre(0, 0));
  EXPECT_THAT(perfect->by_metric[report::kFrechet], Each(DoubleNear(0, 1e-6)));
  absl::StatusOr<report::MethodFigures> captured = scorer->ScoreCaptured();
  ASSERT_TRUE(captured.ok()) << captured.status();
  // These bodies never touch: no depth, which is not a number and equals nothing.
  EXPECT_EQ(perfect->by_metric.erase("penetration_depth_m"), 1u);
  EXPECT_EQ(captured->by_metric.erase("penetration_depth_m"), 1u);
  EXPECT_FALSE(perfect->captured);
  EXPECT_TRUE(captured->captured);
  EXPECT_EQ(captured->by_metric, perfect->by_metric);
  EXPECT_THAT(perfect->by_metric[report::kDiversity], Each(Gt(0)));
  EXPECT_THAT(scorer->JudgeSettings(), SizeIs(2));
}

TEST(FoldScorer, ScoresManyAnswersBesideTheCapturedOnes) {
  const dataset::Dataset dataset = MadeUpPairs(6);
  const absl::StatusOr<FoldScorer> scorer =
      FoldScorer::Create(dataset, *LeaveOut(dataset, {"a"}), FoldScorer::Judging::kFiltered);
  ASSERT_TRUE(scorer.ok()) << scorer.status();
  EXPECT_THAT(scorer->JudgeSettings(), SizeIs(1));
  absl::StatusOr<report::MethodFigures> captured = scorer->ScoreCapturedSamples();
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
  absl::StatusOr<report::MethodFigures> made = scorer->ScoreSamples("made", {answers});
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

TEST(LeaveOut, DefaultsToEverySubject) {
  dataset::Dataset dataset = MadeUpPairs(3);
  const auto subjects = [&dataset](const std::vector<std::string>& asked) {
    std::vector<std::string> names;
    const absl::StatusOr<std::vector<Fold>> folds = LeaveOut(dataset, asked);
    for (const Fold& fold : *folds) names.push_back(fold.subject);
    return names;
  };
  EXPECT_THAT(subjects({"b"}), ElementsAre("b"));
  EXPECT_THAT(subjects({}), ElementsAre("a", "b", "c"));
  for (dataset::Sequence& sequence : dataset.sequences) sequence.subjects.clear();
  EXPECT_TRUE(absl::IsInvalidArgument(LeaveOut(dataset, {}).status()));
}

TEST(ParseRuns, TakesAFolderWithOrWithoutAName) {
  EXPECT_EQ(ParseRuns("ours=runs/x")->name, "ours");
  EXPECT_EQ(ParseRuns("ours=runs/x")->folder, "runs/x");
  EXPECT_EQ(ParseRuns("runs/default")->name, "default");
  EXPECT_EQ(ParseRuns("runs/default/")->name, "default");
  EXPECT_EQ(ParseRuns("runs/default/")->folder, "runs/default/");
  for (const char* bad : {"", "=runs", "ours="}) {
    const absl::Status status = ParseRuns(bad).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << bad << ": " << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("NAME=DIR"));
  }
}

}  // namespace
}  // namespace duet::evaluation::program
